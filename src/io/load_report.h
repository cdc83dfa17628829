/// Fills the reports of loaders.
#pragma once

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/io/load_options.h>

#include "byte_source.h"

namespace hedgerow::detail {

/// Reports on a file whose vertices or points have been read, if a report is wanted.
template <class T, int D>
void report_on(ByteSource& file, const std::vector<Vec<T, D>>& points, const LoadOptions& options) {
    if (options.report == nullptr) return;
    LoadReport& report = *options.report;
    Box<double, D> box;
    for (const Vec<T, D>& p : points) box.expand(Vec<double, D>(p));
    const double side = points.empty() ? 0 : max_component(box.high - box.low);
    const double apart = side / std::sqrt(static_cast<double>(points.size() + 1));
    report.rounding = file.rounding();
    report.loses_detail = side > 0 && report.rounding > apart / 100;
    auto warnings = file.take_warnings();
    report.warnings.insert(report.warnings.end(), std::make_move_iterator(warnings.begin()),
                           std::make_move_iterator(warnings.end()));
}

}  // namespace hedgerow::detail
