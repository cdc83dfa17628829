/// A number that tells models apart.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <variant>

#include <hedgerow/looks/model.h>

namespace hedgerow {

namespace detail {

/// FNV-1a over words of 64 bits, each scattered by a multiplication and a shift.
class Fingerprint {
public:
    template <std::integral I>
    void add(I value) {
        hash_ = (hash_ ^ static_cast<std::uint64_t>(value)) * 0x100000001B3u;
        hash_ ^= hash_ >> 29;
    }
    void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    template <class E>
    requires std::is_enum_v<E>
    void add(E value) { add(static_cast<std::uint64_t>(value)); }
    template <class T, int D>
    void add(const Vec<T, D>& v) {
        for (const T x : v.data) add(x);
    }
    void add(const Rgba& c) { add(c.colour), add(c.alpha); }
    template <class V, std::size_t N>
    void add(const std::array<V, N>& all) {
        for (const V& v : all) add(v);
    }
    template <class V>
    void add(const std::vector<V>& all) {
        add(all.size());
        for (const V& v : all) add(v);
    }
    template <class... More>
    void add_all(const More&... more) {
        (add(more), ...);
    }
    template <class V>
    void add(const CornerValues<V>& c) {
        add_all(c.values, c.corners);
    }
    void add(const TextureSlot& s) { add_all(s.texture, s.set, s.channel, s.transform.u, s.transform.v); }
    void add(const Texture& t) {
        add_all(t.space, t.wrap_s, t.wrap_t, t.filter);
        if (!t.pixels) return;
        add_all(t.pixels->width, t.pixels->height, t.pixels->channels);
        std::visit([&](const auto& samples) { add(samples); }, t.pixels->samples);
    }
    void add(const Material& m) {
        add_all(m.base_colour, m.alpha, m.base_colour_texture, m.alpha_texture, m.alpha_mode, m.alpha_cutoff,
                m.metallic, m.roughness, m.metallic_texture, m.roughness_texture, m.ior, m.specular,
                m.specular_colour, m.emission, m.emission_strength, m.emission_texture, m.normal_texture,
                m.normal_scale, m.transmission, m.transmission_texture, m.thin, m.attenuation_colour,
                m.attenuation_distance, m.double_sided, m.unlit);
    }
    void add(const PointLight& l) { add_all(l.position, l.intensity); }
    void add(const SpotLight& l) { add_all(l.position, l.direction, l.intensity, l.inner, l.outer); }
    void add(const DirectionalLight& l) { add_all(l.direction, l.illuminance); }
    void add(const Light& light) {
        add(light.index());
        std::visit([&](const auto& l) { add(l); }, light);
    }
    void add(const PlacedObject& p) {
        add_all(p.object, p.to_world.there().linear, p.to_world.there().shift);
    }
    template <class T>
    void add(const Object<T>& o) {
        add_all(o.mesh.vertices, o.mesh.triangles, o.materials, o.material, o.attributes.normals,
                o.attributes.texture_coordinates, o.attributes.colours);
    }

    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xCBF29CE484222325u;
};

}  // namespace detail

/// A hash of all of a model that is seen: models that look alike but for names have the same. O(size).
template <class T>
std::uint64_t fingerprint(const Model<T>& model) {
    detail::Fingerprint f;
    f.add_all(model.objects, model.instances, model.materials, model.textures, model.lights);
    if (model.environment)
        f.add_all(model.environment->panorama, model.environment->radiance, model.environment->to_world);
    return f.value();
}

}  // namespace hedgerow
