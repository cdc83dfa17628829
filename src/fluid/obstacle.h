/// A mesh that balls may touch and never pass.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <hedgerow/mesh_index.h>
#include <hedgerow/surface.h>

namespace hedgerow::detail {

/// The share of a way that a ball has moved, and whether the mesh ended it, with the surface's normal on the
/// ball's side.
struct Moved {
    double share = 1;
    bool ended = false;
    Vec3d normal;
};

/// How far away the mesh is from a place, and the direction from its closest point to the place.
struct Touch {
    double distance;
    Vec3d normal;
};

class Obstacle {
public:
    /// Borrows the index of the mesh. Null: there is no mesh.
    explicit Obstacle(const MeshIndex<double>* mesh)
        : mesh_(mesh != nullptr && !mesh->bounds().empty() ? mesh : nullptr) {
        if (mesh_ != nullptr)
            scale_ =
                std::max(max_component(abs(mesh_->bounds().low)), max_component(abs(mesh_->bounds().high)));
    }
    explicit operator bool() const { return mesh_ != nullptr; }

    /// The least distance from the mesh at which a move may end. All errors of the move, of a hit's t and of
    /// a distance are below 2⁻⁴⁸ of the largest coordinate (probes/ray.h).
    double margin(const Vec3d& place, const Vec3d& way) const {
        return 0x1p-40 * (scale_ + max_component(abs(place)) + max_component(abs(way)));
    }

    /// The closest point of the mesh, if it is within a distance. In a place on the mesh the normal is that
    /// of the triangle.
    std::optional<Touch> touch(const Vec3d& place, double within) const {
        const auto near = closest_point(*mesh_, place, {.radius = within});
        if (!near) return {};
        const double distance = std::sqrt(near.distance2);
        const Vec3d away = place - near.point;
        return Touch{distance,
                     max_component(abs(away)) > 0 ? unit(away) : feature(*mesh_, place, near).normal};
    }

    /// Moves a ball along a straight way until its surface reaches the mesh where its center would hit it.
    ///
    /// The ball stays on its side of the mesh: the ray hits nothing between both ends but for rounding
    /// errors, and a move that would end so close to the mesh that these matter is not made. A way shorter
    /// than the distance to the mesh needs no ray; `distance` is that or less, 0 if it is not known.
    Moved move(Vec3d& place, const Vec3d& way, double radius, double distance = 0) const {
        const double least = margin(place, way);
        Moved moved;
        if (length(way) < distance - 2 * least) {
            place += way;
            return moved;
        }
        const Ray<double, 3> ray{place, way, 0, 1};
        if (const auto hit = closest_hit(*mesh_, ray)) {
            moved.ended = true;
            moved.normal = normal(*mesh_, ray, hit);
            if (dot(moved.normal, way) > 0) moved.normal = -moved.normal;
            // The part of the way on which the distance to the plane shrinks from the radius to 0.
            const double back = std::max(radius, 2 * least) / -dot(moved.normal, way);
            moved.share = std::max(0.0, hit.t - back);
        }
        const Vec3d end = place + way * moved.share;
        if (moved.share == 0 || !touch(end, least)) {
            place = end;
        } else {
            moved.share = 0, moved.ended = true;
            if (const auto here = touch(place, std::numeric_limits<double>::max()))
                moved.normal = here->normal;
        }
        return moved;
    }

    /// Moves a ball out of what it overlaps of the mesh, as far as there is room: away from the closest
    /// point, three times at most, since a corner has three walls.
    void push_out(Vec3d& place, double radius) const {
        const double least = margin(place, {});
        for (int wall = 0; wall < 3 && radius > least; ++wall) {
            const auto at = touch(place, radius - least);
            if (!at) return;
            move(place, at->normal * (radius - at->distance), 0, at->distance);
        }
    }
    /// Puts a ball whose center lies on the mesh in front of its triangle. It has no side of its own yet.
    void release(Vec3d& place, double radius) const {
        const double least = margin(place, {});
        const auto on = closest_point(*mesh_, place, {.radius = least});
        if (on) place = on.point + feature(*mesh_, place, on).normal * std::max(radius, 4 * least);
    }

private:
    const MeshIndex<double>* mesh_;
    double scale_ = 0;  // the largest coordinate of the mesh
};

}  // namespace hedgerow::detail
