/// What a model says at a hit: its material there, with textures and values of corners looked up.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <hedgerow/looks/model.h>
#include <hedgerow/looks/texture_levels.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/render/shading/footprint.h>

namespace hedgerow {

/// A hit on a model: `instance` is a place in a list that names instances of the model, and `element` a
/// triangle of its object. Values are means over a part of the surface; the levels of a texture are computed
/// at its first lookup with an extent. Borrows the model. Const use is thread-safe; each lookup is O(1).
template <std::floating_point T>
class ModelLookups {
public:
    /// A part of a triangle, by how u and v change along its half axes.
    struct Extent {
        Vec2f a, b;

        bool is_point() const { return a == Vec2f() && b == Vec2f(); }
    };

    ModelLookups(const Model<T>& model, std::vector<std::uint32_t> instances)
        : model_(model), instances_(std::move(instances)), levels_(model.textures.size()) {}

    const Model<T>& model() const { return model_; }
    const PlacedObject& placed(const Hit<T>& hit) const { return model_.instances[instances_[hit.instance]]; }
    const Object<T>& object(const Hit<T>& hit) const { return model_.objects[placed(hit).object]; }
    const Material& material(const Hit<T>& hit) const {
        return model_.materials[object(hit).material_of(hit.element)];
    }
    Extent extent_of(const Hit<T>& hit, const SurfaceFootprint& part) const {
        if (part.a == Vec3d() && part.b == Vec3d()) return {};
        const auto triangle = object(hit).mesh.view().triangle(hit.element);
        const Vec3d ab = Vec3d(triangle.b) - Vec3d(triangle.a), ac = Vec3d(triangle.c) - Vec3d(triangle.a);
        const Vec3d normal = cross(ab, ac);
        const auto& back = placed(hit).to_world.back();
        const auto along = [&](const Vec3d& axis) {
            const Vec3d d = back.vector(axis);
            return Vec2f(Vec2d(dot(cross(d, ac), normal), dot(cross(ab, d), normal)) / length2(normal));
        };
        return {along(part.a), along(part.b)};
    }

    Vec3f base_colour(const Hit<T>& hit, const Extent& part) const {
        const Material& m = material(hit);
        Vec3f colour = m.base_colour;
        if (m.base_colour_texture) colour = tinted(colour, texel(m.base_colour_texture, hit, part).colour);
        if (const auto corner = colour_of_corners(hit)) colour = tinted(colour, corner->colour);
        return colour;
    }
    /// The opacity; of a mask 0 or 1.
    float alpha(const Hit<T>& hit, const Extent& part) const {
        const Material& m = material(hit);
        if (m.alpha_mode == AlphaMode::opaque) return 1;
        float alpha = m.alpha * number(m.alpha_texture, hit, part);
        if (const auto corner = colour_of_corners(hit)) alpha *= corner->alpha;
        if (m.alpha_mode == AlphaMode::mask) return alpha >= m.alpha_cutoff ? 1.0f : 0.0f;
        return alpha;
    }
    Vec3f emission(const Hit<T>& hit, const Extent& part) const {
        const Material& m = material(hit);
        const Vec3f constant = m.emission * m.emission_strength;
        if (!m.emission_texture) return constant;
        return tinted(constant, texel(m.emission_texture, hit, part).colour);
    }
    /// The channel of a slot that varies a number; 1 without a texture.
    float number(const TextureSlot& slot, const Hit<T>& hit, const Extent& part) const {
        if (!slot) return 1;
        const Rgba value = texel(slot, hit, part);
        return slot.channel < 3 ? value.colour[slot.channel] : value.alpha;
    }
    /// The mean colour of a texture.
    Vec3f mean_of(const TextureSlot& slot) const {
        return levels_of(slot.texture).mean(model_.textures[slot.texture]).colour;
    }
    /// The normal of the corners at a hit, of length 1, in the world, on either side. 0 where they have none.
    Vec3f smooth_normal(const Hit<T>& hit) const {
        const auto own = normal_of_corners(hit, u(hit), v(hit));
        return own ? Vec3f(normal_in_world(hit, Vec3d(*own))) : Vec3f();
    }
    /// The way in the world from a hit to the smooth surface over its triangle that has the corners' normals;
    /// 0 where they have none, and where the surface is not out from the triangle. Out is to the front; to
    /// the back if `side` is −1. The surface is taken for the mean of the corners' planes, by the weights of
    /// the corners (Hanika, Hacking the shadow terminator, Ray Tracing Gems II, 2021).
    Vec3f way_to_smooth(const Hit<T>& hit, double side) const {
        const auto triangle = object(hit).mesh.view().triangle(hit.element);
        const Vec3d a(triangle.a), ab = Vec3d(triangle.b) - a, ac = Vec3d(triangle.c) - a;
        const double to_b = static_cast<double>(hit.u), to_c = static_cast<double>(hit.v);
        const Vec3d from_a = ab * to_b + ac * to_c;
        Vec3d way;
        const auto add_plane = [&](float of_b, float of_c, const Vec3d& from_corner, double weight) {
            const auto given = normal_of_corners(hit, of_b, of_c);
            if (!given) return;
            const Vec3d n = normalized(Vec3d(*given)) * side;
            const double height = dot(n, from_corner);
            if (height < 0) way = way - n * product(weight, height);
        };
        add_plane(0, 0, from_a, 1 - to_b - to_c);
        add_plane(1, 0, from_a - ab, to_b);
        add_plane(0, 1, from_a - ac, to_c);
        return Vec3f(placed(hit).to_world.there().vector(way));
    }
    /// The surface's own normal, that of its corners and its map of normals, of length 1, in the world, on
    /// either side. 0 where it has none.
    Vec3f own_normal(const Hit<T>& hit, const Extent& part) const {
        const auto of_corners = normal_of_corners(hit, u(hit), v(hit));
        const Material& m = material(hit);
        if (!of_corners && !m.normal_texture) return {};
        const auto triangle = object(hit).mesh.view().triangle(hit.element);
        const Vec3d e1 = Vec3d(triangle.b) - Vec3d(triangle.a), e2 = Vec3d(triangle.c) - Vec3d(triangle.a);
        const Vec3d normal = normal_in_world(hit, of_corners ? Vec3d(*of_corners) : cross(e1, e2));
        if (!m.normal_texture) return Vec3f(normal);
        return mapped_normal(hit, part, normal, e1, e2);
    }
    /// The texture coordinates at a hit, of the first set, as they were given; nothing of a surface without.
    std::optional<Vec2f> texture_coordinates(const Hit<T>& hit) const {
        const auto& sets = object(hit).attributes.texture_coordinates;
        return sets.empty() ? std::nullopt : sets[0].at(object(hit).mesh, hit.element, u(hit), v(hit));
    }

private:
    struct LevelsOnDemand {
        std::once_flag computed;
        std::unique_ptr<const TextureLevels> levels;
    };

    static float u(const Hit<T>& hit) { return static_cast<float>(hit.u); }
    static float v(const Hit<T>& hit) { return static_cast<float>(hit.v); }
    std::optional<Vec3f> normal_of_corners(const Hit<T>& hit, float u, float v) const {
        return object(hit).attributes.normals.at(object(hit).mesh, hit.element, u, v);
    }
    std::optional<Rgba> colour_of_corners(const Hit<T>& hit) const {
        return object(hit).attributes.colours.at(object(hit).mesh, hit.element, u(hit), v(hit));
    }
    /// The set of texture coordinates of a slot; null where the surface lacks it.
    const CornerValues<Vec2f>* set_of(const TextureSlot& slot, const Hit<T>& hit) const {
        const auto& sets = object(hit).attributes.texture_coordinates;
        return slot.set < sets.size() ? &sets[slot.set] : nullptr;
    }
    /// The texture of a slot around a hit; white where the surface lacks its coordinates.
    Rgba texel(const TextureSlot& slot, const Hit<T>& hit, const Extent& part) const {
        const CornerValues<Vec2f>* const set = set_of(slot, hit);
        const TriangleMesh<T>& mesh = object(hit).mesh;
        const auto at = set ? set->at(mesh, hit.element, u(hit), v(hit)) : std::nullopt;
        if (!at) return {Vec3f::all(1), 1};
        const Texture& texture = model_.textures[slot.texture];
        if (part.is_point()) return texture.at(slot.transform(*at));
        const auto along = [&](const Vec2f& axis) {
            return slot.transform.of_difference(*set->difference(mesh, hit.element, axis[0], axis[1]));
        };
        return levels_of(slot.texture).at(texture, slot.transform(*at), {along(part.a), along(part.b)});
    }
    /// Textures of the same pixels and colour space share their levels.
    const TextureLevels& levels_of(std::uint32_t texture) const {
        const Texture& t = model_.textures[texture];
        std::size_t first = 0;
        while (model_.textures[first].pixels != t.pixels || model_.textures[first].space != t.space) ++first;
        LevelsOnDemand& l = levels_[first];
        std::call_once(l.computed, [&] { l.levels = std::make_unique<const TextureLevels>(t); });
        return *l.levels;
    }
    /// The unit vector of a normal of the object, which transforms by the inverse transposed.
    Vec3d normal_in_world(const Hit<T>& hit, const Vec3d& own) const {
        const auto& back = placed(hit).to_world.back().linear;
        Vec3d there;
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) there[k] += product(back[static_cast<std::size_t>(j)][k], own[j]);
        return normalized(there);
    }
    /// A normal turned by a map: x along growing texture coordinates u, y along falling v, which is up in the
    /// image, z along the normal (glTF 2.0, 3.9.3). The normal itself where the coordinates do not span a
    /// plane.
    Vec3f mapped_normal(const Hit<T>& hit, const Extent& part, const Vec3d& normal, const Vec3d& e1,
                        const Vec3d& e2) const {
        const TextureSlot& slot = material(hit).normal_texture;
        const CornerValues<Vec2f>* const set = set_of(slot, hit);
        const TriangleMesh<T>& mesh = object(hit).mesh;
        const auto d1 = set ? set->difference(mesh, hit.element, 1, 0) : std::nullopt;
        const auto d2 = set ? set->difference(mesh, hit.element, 0, 1) : std::nullopt;
        if (!d1 || !d2) return Vec3f(normal);
        const Vec2d a(slot.transform.of_difference(*d1)), b(slot.transform.of_difference(*d2));
        const double area = product(a[0], b[1]) - product(a[1], b[0]);
        // Directions alone matter, so the area counts by its sign.
        const double side = area < 0 ? -1 : 1;
        const Vec3d along_u = placed(hit).to_world.there().vector((e1 * b[1] - e2 * a[1]) * side),
                    along_v = placed(hit).to_world.there().vector((e2 * a[0] - e1 * b[0]) * side);
        const Vec3d tangent = along_u - normal * dot(along_u, normal);
        if (!(length2(tangent) > 0) || area == 0) return Vec3f(normal);
        const Vec3d x = normalized(tangent), across = cross(normal, x);
        const Vec3d y = dot(across, along_v) > 0 ? -across : across;
        const Rgba texel_there = texel(slot, hit, part);
        const double scale = static_cast<double>(material(hit).normal_scale);
        const Vec3d map = Vec3d(texel_there.colour) * 2.0 - Vec3d::all(1);
        const Vec3d turned = x * (map[0] * scale) + y * (map[1] * scale) + normal * map[2];
        return length2(turned) > 0 ? Vec3f(normalized(turned)) : Vec3f(normal);
    }

    const Model<T>& model_;
    std::vector<std::uint32_t> instances_;
    mutable std::vector<LevelsOnDemand> levels_;  // by texture
};

}  // namespace hedgerow
