/// Wavefront materials ("Object Files (.obj)" and "MTL material format", Wavefront's Advanced Visualizer
/// manual, appendix B; the words of physically based rendering that begin with P are those of Clara.io).
#include "mtl.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "byte_source.h"
#include "gltf_uri.h"
#include "text_source.h"

namespace hedgerow::detail {

namespace {

/// A material as its lines say it.
struct MtlEntry {
    std::string name;
    std::optional<Vec3f> diffuse, filter;                                            // Kd, Tf
    Vec3f specular, emission;                                                        // Ks, Ke
    std::optional<float> exponent, ior, opacity, transparency, roughness, metallic;  // Ns, Ni, d, Tr, Pr, Pm
    int illumination = 2;
    float bump_scale = 1;
    TextureSlot diffuse_map, opacity_map, emission_map, roughness_map, metallic_map, normal_map;
};

/// A map's options and file.
struct MtlMap {
    Vec3f scale{1, 1, 1}, offset;
    bool clamped = false;
    std::optional<std::uint8_t> channel;
    float multiplier = 1;  // -bm
    std::string file;
};

/// The map of stored texture coordinates, whose v counts from the top, that scales and moves v from the
/// bottom.
TextureTransform texture_transform_of(const MtlMap& map) {
    const float s = map.scale[1];
    return {{map.scale[0], 0, map.offset[0]}, {0, s, 1 - s - map.offset[1]}};
}

bool is_glass(int illumination) {
    return illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9;
}

/// The reflection at normal incidence. Models 3 and 5 trace reflections, which Ks weighs. In others Ks weighs
/// a highlight, and 1/2 is that of an ordinary dielectric.
void set_specular(const MtlEntry& e, Material& m) {
    const bool is_measured = e.roughness || e.metallic || e.metallic_map,
               shines = max_component(e.specular) > 0;
    m.specular = 1;
    if (is_glass(e.illumination) || (is_measured && !shines)) return;
    if (!shines || (e.illumination < 2 && !is_measured)) {
        m.specular = 0;
        return;
    }
    const float r = (m.ior - 1) / (m.ior + 1);
    const bool is_mirror = e.illumination == 3 || e.illumination == 5;
    m.specular_colour = e.specular * (is_mirror ? 1 / (r * r) : 2);
}

Material material_of(const MtlEntry& e) {
    Material m;
    m.name = e.name;
    m.base_colour = e.diffuse.value_or(Vec3f::all(e.diffuse_map ? 1.f : 0.8f));
    m.base_colour_texture = e.diffuse_map;
    m.alpha = std::clamp(e.opacity.value_or(1 - e.transparency.value_or(0)), 0.f, 1.f);
    m.alpha_texture = e.opacity_map;
    m.alpha_mode = m.alpha < 1 || e.opacity_map ? AlphaMode::blend : AlphaMode::opaque;
    m.emission = e.emission;
    m.emission_texture = e.emission_map;
    if (e.emission_map && max_component(e.emission) <= 0) m.emission = Vec3f::all(1);
    // An index of 1 is what programs write that know none: an opaque body has none that is less than air's.
    m.ior = std::max(e.ior.value_or(1.5f), 1.f);
    if (m.ior < 1.01f && !is_glass(e.illumination)) m.ior = 1.5f;
    // An exponent of Phong's lobe is nearly GGX with α = √(2 / (Ns + 2)) (Walter et al. 2007).
    const float exponent = std::max(e.exponent.value_or(0), 0.f);
    m.roughness = std::clamp(e.roughness.value_or(std::sqrt(std::sqrt(2 / (exponent + 2)))), 0.f, 1.f);
    m.roughness_texture = e.roughness_map;
    m.metallic = std::clamp(e.metallic.value_or(e.metallic_map ? 1.f : 0.f), 0.f, 1.f);
    m.metallic_texture = e.metallic_map;
    m.normal_texture = e.normal_map;
    m.normal_scale = e.bump_scale;
    if (is_glass(e.illumination)) {  // a body: light that enters is refracted and coloured by Tf
        m.transmission = 1;
        m.thin = false;
        m.base_colour = e.filter.value_or(Vec3f::all(1));
        m.alpha = 1;
        if (!e.opacity_map) m.alpha_mode = AlphaMode::opaque;
    }
    set_specular(e, m);
    return m;
}

class MtlReader {
public:
    MtlReader(const std::filesystem::path& path, const ModelContext& context)
        : path_(path),
          file_(path),
          textures_(context.textures),
          not_shown_(context.not_shown),
          warnings_(context.warnings) {}

    void read(MaterialsByName& materials) {
        std::string text;
        while (lines_.next(text)) {
            rest_ = trimmed(text);
            const std::string_view word = take_word(rest_);
            if (word == "newmtl") {
                finish(materials);
                entry_ = MtlEntry{};
                entry_->name = trimmed(rest_);
            } else if (!word.empty() && word[0] != '#' && entry_) {
                read_word(word);
            }
        }
        finish(materials);
    }

private:
    void finish(MaterialsByName& materials) {
        if (entry_) materials.try_emplace(entry_->name, material_of(*entry_));
    }
    [[noreturn]] void fail(const std::string& what) const { lines_.fail(what + ". Repair the file"); }
    float number() {
        const std::string_view word = take_word(rest_);
        const auto x = parse_real<float>(word);
        if (!x || !std::isfinite(*x)) fail(shown(word) + " where a number should stand");
        return *x;
    }
    /// Up to three numbers. One alone stands for all; a word that is no number ends them.
    Vec3f numbers(const Vec3f& otherwise, bool one_is_all) {
        Vec3f v = otherwise;
        v[0] = number();
        int i = 1;
        for (; i < 3; ++i) {
            std::string_view after = rest_;
            const auto x = parse_real<float>(take_word(after));
            if (!x) break;
            v[i] = number();
        }
        return one_is_all && i == 1 ? Vec3f::all(v[0]) : v;
    }
    /// A colour, in which what is negative counts as 0, with a warning; nothing for one by a spectrum or in
    /// XYZ.
    std::optional<Vec3f> colour(std::string_view word) {
        std::string_view after = rest_;
        const std::string_view first = take_word(after);
        if (first == "spectral" || first == "xyz") {
            not_shown_.add(std::string(word) + " " + std::string(first) + " (MTL)");
            return std::nullopt;
        }
        const Vec3f value = numbers({}, true), light = max(value, Vec3f());
        if (value != light)
            warnings_.add(file_.name() + ": line " + std::to_string(lines_.number()) + ": " +
                          std::string(word) + " has a negative number, which counts as 0");
        return light;
    }

    void read_word(std::string_view word) {
        MtlEntry& e = *entry_;
        if (word == "Kd") {
            if (const auto c = colour(word)) e.diffuse = c;
        } else if (word == "Ks") {
            e.specular = colour(word).value_or(e.specular);
        } else if (word == "Ke") {
            e.emission = colour(word).value_or(e.emission);
        } else if (word == "Tf") {
            if (const auto c = colour(word)) e.filter = c;
        } else if (word == "Ns") {
            e.exponent = number();
        } else if (word == "Ni") {
            e.ior = number();
        } else if (word == "d") {
            read_opacity();
        } else if (word == "Tr") {
            e.transparency = number();
        } else if (word == "Pr") {
            e.roughness = number();
        } else if (word == "Pm") {
            e.metallic = number();
        } else if (word == "illum") {
            e.illumination = static_cast<int>(std::clamp(number(), 0.f, 100.f));
        } else {
            read_map_word(word);
        }
    }
    void read_opacity() {
        std::string_view after = rest_;
        if (take_word(after) == "-halo") {
            not_shown_.add("d -halo (MTL)");
            rest_ = after;
        }
        entry_->opacity = number();
    }
    void read_map_word(std::string_view word) {
        MtlEntry& e = *entry_;
        const std::string lower = lower_case(word);
        if (lower == "map_kd")
            e.diffuse_map = slot(read_map(), true);
        else if (lower == "map_ke")
            e.emission_map = slot(read_map(), true);
        else if (lower == "map_d")
            e.opacity_map = slot(read_map(), false, true);
        else if (lower == "map_pr")
            e.roughness_map = slot(read_map(), false);
        else if (lower == "map_pm")
            e.metallic_map = slot(read_map(), false);
        else if (lower == "norm")
            read_normal_map();
        else
            not_shown_.add(std::string(word.substr(0, 40)) + " (MTL)");
    }
    void read_normal_map() {
        const MtlMap map = read_map();
        entry_->normal_map = slot(map, false);
        entry_->bump_scale = map.multiplier;
    }

    MtlMap read_map() {
        MtlMap map;
        for (rest_ = trimmed(rest_); rest_.starts_with('-');) {
            const std::string_view option = take_word(rest_);
            if (option == "-s")
                map.scale = numbers(map.scale, false);
            else if (option == "-o")
                map.offset = numbers(map.offset, false);
            else if (option == "-clamp")
                map.clamped = take_word(rest_) == "on";
            else if (option == "-imfchan")
                map.channel = channel(take_word(rest_));
            else if (option == "-bm")
                map.multiplier = number();
            else
                skip_option(option);
            rest_ = trimmed(rest_);
        }
        map.file = rest_;
        if (map.file.empty()) fail("a map without a file");
        return map;
    }
    static std::optional<std::uint8_t> channel(std::string_view letter) {
        constexpr std::string_view letters = "rgbm";
        const auto at = letters.find(letter);
        if (letter.size() != 1 || at == letters.npos) return std::nullopt;
        return static_cast<std::uint8_t>(at);
    }
    void skip_option(std::string_view option) {
        not_shown_.add("option " + std::string(option.substr(0, 40)) + " of maps (MTL)");
        if (option == "-t")
            numbers({}, false);
        else if (option == "-mm")
            number(), number();
        else
            take_word(rest_);
    }
    /// A texture of colours, or of numbers: these are the opacity of an image if `is_opacity` and the image
    /// has one, else the map's channel.
    TextureSlot slot(const MtlMap& map, bool is_colour, bool is_opacity = false) {
        TextureSlot slot;
        Texture like;
        like.name = (path_.parent_path() / map.file).lexically_normal().string();
        like.space = is_colour ? ColourSpace::srgb : ColourSpace::linear;
        like.wrap_s = like.wrap_t = map.clamped ? Wrap::clamp : Wrap::repeat;
        const auto ordinal = textures_.texture(like, is_colour, [&](const PixelLimits& limits) {
            return load_pixels(file_beside(map.file, path_, path_.string(), "texture"), limits);
        });
        if (!ordinal) return slot;
        slot.texture = *ordinal;
        slot.transform = texture_transform_of(map);
        const bool has_opacity = textures_[*ordinal].pixels->channels % 2 == 0;
        slot.channel = map.channel.value_or(is_opacity && has_opacity ? std::uint8_t(3) : std::uint8_t(0));
        return slot;
    }

    const std::filesystem::path& path_;
    ByteSource file_;
    LineSource lines_{file_};
    TextureShelf& textures_;
    NamedOnce& not_shown_;
    NamedOnce& warnings_;
    std::string_view rest_;
    std::optional<MtlEntry> entry_;
};

}  // namespace

void read_mtl(const std::filesystem::path& path, const ModelContext& context, MaterialsByName& materials) {
    MtlReader(path, context).read(materials);
}

}  // namespace hedgerow::detail
