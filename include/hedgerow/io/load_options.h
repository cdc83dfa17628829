/// Options that all loaders share, and what loaders and writers report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hedgerow {

/// How far coordinates were moved when they were rounded to numbers of fewer digits.
struct RoundingReport {
    /// The farthest that a coordinate was moved.
    double rounding = 0;
    /// Whether `rounding` is more than a hundredth of the usual distance between neighbours (the largest side
    /// of the scene's box over the root of the number of points), which is 0 if rounding has put all points
    /// in one place. Then load the file as doubles, or save a mesh in a format that has them.
    bool loses_detail = false;
};

/// What a loader tells of a file beside its contents. Coordinates of the file are rounded to the scalar type
/// of the scene.
struct LoadReport : RoundingReport {
    /// Points or vertices, and faces, that `drop_bad` left out.
    std::uint64_t dropped_points = 0, dropped_faces = 0;
    /// Of a cloud from which points were left out: the ordinals in the file of those that stay. Else empty.
    std::vector<std::uint32_t> kept_points;
    /// A sentence for each peculiarity of the file that changes nothing but should be known. Each names the
    /// file.
    std::vector<std::string> warnings;
};

struct LoadOptions {
    /// Leaves out elements with a coordinate that is NaN, infinite or beyond `largest_coordinate<T>`, instead
    /// of throwing. A mesh loses such vertices and, whole, the faces that use them. Faces that stay keep
    /// their ids (ordinals in the file); vertices that stay are renumbered. A point cloud loses such points,
    /// and the rest move up; the report has their ordinals in the file.
    bool drop_bad = false;
    /// Where the loader writes its report, or null.
    LoadReport* report = nullptr;
};

}  // namespace hedgerow
