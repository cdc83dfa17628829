#include "saved_picture.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <span>

#include <fmt/format.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/state_file.h>
#include <hedgerow/looks/fingerprint.h>
#include <hedgerow/version.h>

namespace hedgerow::cli {

namespace {

constexpr const char* kind_of_state = "paths";
constexpr std::uint32_t state_version = 4;

std::string text_of(const Camera& c) {
    const auto vector = [](const Vec3f& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); };
    return fmt::format(
        "eye {}, target {}, up {}, projection {}, field of view {}, height {}, lens {}, focus {}",
        vector(c.eye), vector(c.target), vector(c.up), static_cast<int>(c.projection), c.field_of_view,
        c.height, c.lens_radius, c.focus);
}

}  // namespace

template <class T>
SavedPicture::SavedPicture(const RenderArguments& a, const ShownModel<T>& shown,
                           const PathPictureOptions& options)
    : file_(a.resume), halves_(options.division == Division::even ? 1 : 2) {
    if (!has_file()) return;
    of_ = {{"version", std::string(version)},
           {"precision", sizeof(T) == sizeof(float) ? "float" : "double"},  // another scene, too
           {"scene", fmt::format("{:016x}", fingerprint(shown.model))},
           {"camera", text_of(options.camera)},
           {"size", fmt::format("{}x{}", options.width, options.height)},
           {"seed", std::to_string(a.seed)},
           {"sampler", a.sampler},
           {"filter", a.filter},
           {"division", std::string(division_names[static_cast<std::size_t>(options.division)])},
           {"bounces", std::to_string(a.bounces)}};
}
template SavedPicture::SavedPicture(const RenderArguments&, const ShownModel<float>&,
                                    const PathPictureOptions&);
template SavedPicture::SavedPicture(const RenderArguments&, const ShownModel<double>&,
                                    const PathPictureOptions&);

PathPicture SavedPicture::begun(const RenderArguments& a, PathPictureOptions& options) const {
    if (!has_file() || !std::filesystem::exists(file_))
        return {options.width, options.height, options.keeps_direct};
    PathPicture picture = load(options.width, options.height);
    if (options.keeps_direct && !picture.keeps_direct())
        fmt::print(stderr,
                   "hedgerow: warning: {} was begun for a .png, so {} lacks the layers direct and indirect\n",
                   file_, a.output);
    options.keeps_direct = picture.keeps_direct();
    return picture;
}

// The bytes of a state: the picture's samples, whether it keeps direct light and has spreads, the sums of the
// halves of its light and of its direct light, and its spreads.
void SavedPicture::write(const PathPicture& picture) const {
    const std::array<std::uint64_t, 3> head{picture.samples, picture.keeps_direct(),
                                            !picture.spreads[0].empty()};
    std::vector<std::span<const std::byte>> parts{std::as_bytes(std::span(head))};
    for (const LightHalves* const light : {&picture.light, &picture.direct})
        for (int half = 0; half < halves_; ++half)
            parts.push_back(std::as_bytes(std::span(light->half(half).pixels())));
    for (const auto& spreads : picture.spreads) parts.push_back(std::as_bytes(std::span(spreads)));
    save_state(file_, kind_of_state, state_version, of_, parts);
}
PathPicture SavedPicture::load(int width, int height) const {
    const WorkState state = load_state(file_, kind_of_state, state_version, of_);
    std::span<const std::byte> rest = state.bytes;
    const auto take = [&rest](auto& numbers) {
        const auto into = std::as_writable_bytes(std::span(numbers));
        std::memcpy(into.data(), rest.data(), into.size());
        rest = rest.subspan(into.size());
    };
    std::array<std::uint64_t, 3> head{};
    if (rest.size() > sizeof(head)) take(head);
    const bool keeps_direct = head[1] != 0, has_spreads = head[2] != 0;
    PathPicture picture(width, height, keeps_direct);
    const std::size_t pixels = picture.light.size(),
                      sums = static_cast<std::size_t>(halves_) * (keeps_direct ? 2 : 1);
    if (rest.size() != pixels * (sums * sizeof(LightSums::Pixel) + (has_spreads ? 2 * sizeof(float) : 0)))
        throw InputError(file_ + ": has another number of pixels than its size says");
    const auto take_light = [&](LightHalves& light) {
        for (int half = 0; half < halves_; ++half) {
            std::vector<LightSums::Pixel> all(pixels);
            take(all);
            light.half(half) = LightSums(std::move(all));
        }
    };
    picture.samples = static_cast<std::uint32_t>(head[0]);
    take_light(picture.light);
    if (keeps_direct) take_light(picture.direct);
    if (has_spreads)
        for (auto& spreads : picture.spreads) spreads.resize(pixels), take(spreads);
    return picture;
}

void SavedPicture::finish_copy() {
    if (saving_.valid()) saving_.get();
}
void SavedPicture::save(const PathPicture& picture) {
    finish_copy();
    write(picture);
}
void SavedPicture::begin_to_save(const PathPicture& picture) {
    finish_copy();
    copy_ = picture;
    saving_ = std::async(std::launch::async, [this] { write(copy_); });
}

}  // namespace hedgerow::cli
