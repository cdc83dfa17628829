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

/// What it means for so many vertices or points, and the box of all, that their coordinates were moved by up
/// to `rounding`. Where all are in one place, they may have been apart before.
template <int D>
RoundingReport rounding_report(double rounding, const Box<double, D>& box, std::uint64_t count) {
    const double side = count == 0 ? 0 : max_component(box.high - box.low);
    const double apart = side / std::sqrt(static_cast<double>(count + 1));
    return {rounding, count > 1 && rounding > apart / 100};
}
template <class T, int D>
Box<double, D> box_of(const std::vector<Vec<T, D>>& points) {
    Box<double, D> box;
    for (const Vec<T, D>& p : points) box.expand(Vec<double, D>(p));
    return box;
}

/// The report on a file of which so many vertices or points have been read.
template <int D>
LoadReport report_of(ByteSource& file, const Box<double, D>& box, std::uint64_t count) {
    return {rounding_report(file.rounding(), box, count), 0, 0, {}, file.take_warnings()};
}
/// Adds to a report, if one is wanted, what is told of a file whose vertices or points have been read.
template <class T, int D>
void report_on(ByteSource& file, const std::vector<Vec<T, D>>& points, const LoadOptions& options) {
    if (options.report == nullptr) return;
    LoadReport report = report_of(file, box_of(points), points.size());
    static_cast<RoundingReport&>(*options.report) = report;
    options.report->warnings.insert(options.report->warnings.end(),
                                    std::make_move_iterator(report.warnings.begin()),
                                    std::make_move_iterator(report.warnings.end()));
}

}  // namespace hedgerow::detail
