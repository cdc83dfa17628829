/// Figures as text for people: three digits and a suitable unit.
#pragma once

#include <string>

namespace hedgerow::measure {

/// Seconds with a unit: "812 ns", "1.04 ms".
std::string seconds_text(double seconds);
/// Bytes with a unit: "1.72 MB".
std::string bytes_text(double bytes);
/// A count in three digits: "121", "5.99k", "1.20M".
std::string count_text(double count);
/// A number in three significant digits: "0.0123", "4.56", "123", "12,300". Whole numbers are written in
/// full.
std::string number_text(double value);

}  // namespace hedgerow::measure
