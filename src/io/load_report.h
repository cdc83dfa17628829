/// Fills the reports of loaders and writers.
#pragma once

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/io/load_options.h>

#include "byte_source.h"

namespace hedgerow::detail {

/// What it means for some vertices or points that their coordinates were moved by up to `rounding`. Where all
/// are in one place, they may have been apart before.
template <class T, int D>
RoundingReport rounding_report(double rounding, const std::vector<Vec<T, D>>& points) {
    Box<double, D> box;
    for (const Vec<T, D>& p : points) box.expand(Vec<double, D>(p));
    const double side = points.empty() ? 0 : max_component(box.high - box.low);
    const double apart = side / std::sqrt(static_cast<double>(points.size() + 1));
    return {rounding, points.size() > 1 && rounding > apart / 100};
}

/// Reports on a file whose vertices or points have been read, if a report is wanted.
template <class T, int D>
void report_on(ByteSource& file, const std::vector<Vec<T, D>>& points, const LoadOptions& options) {
    if (options.report == nullptr) return;
    LoadReport& report = *options.report;
    static_cast<RoundingReport&>(report) = rounding_report(file.rounding(), points);
    auto warnings = file.take_warnings();
    report.warnings.insert(report.warnings.end(), std::make_move_iterator(warnings.begin()),
                           std::make_move_iterator(warnings.end()));
}

}  // namespace hedgerow::detail
