/// Figures for people: three digits and a unit that fits.
#pragma once

#include <string>

namespace hedgerow::compare {

/// "812 ns", "1.04 ms".
std::string seconds_text(double seconds);
/// "1.72 MB".
std::string bytes_text(double bytes);
/// Three digits of a count: "121", "5.99k", "1.20M".
std::string count_text(double count);
/// Three significant digits: "0.0123", "4.56", "123", "12,300"; whole numbers are written in full.
std::string number_text(double value);

}  // namespace hedgerow::compare
