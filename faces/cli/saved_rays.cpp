#include "saved_rays.h"

#include <filesystem>

#include <fmt/format.h>

#include <hedgerow/base/error.h>
#include <hedgerow/columns.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/io/writable.h>
#include <hedgerow/render/integrators/bounce_rays.h>

#include "progress_line.h"

namespace hedgerow::cli {

namespace {

constexpr std::uint64_t most_paths = 1'000'000;

std::string file_of(const std::string& prefix, std::size_t bounce, const char* kind = "") {
    return fmt::format("{}-{}{}.npy", prefix, bounce, kind);
}
template <class T>
void save(const std::string& file, const std::vector<Ray<T, 3>>& rays) {
    constexpr std::size_t words = RayArray<T, 3>::words;
    const RayArray<T, 3> all(rays);
    std::vector<T> numbers;
    numbers.reserve(words * rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (std::size_t w = 0; w < words; ++w) numbers.push_back(all.word(i, w));
    save_npy(file, std::span<const T>(numbers), {rays.size(), words});
}

/// Whether neighbouring rays go much the same way.
bool coherent(const std::vector<Ray3f>& rays) {
    double sum = 0;
    for (std::size_t i = 1; i < rays.size(); ++i)
        sum += double(dot(normalized(rays[i - 1].direction), normalized(rays[i].direction)));
    return sum > 0.9 * double(rays.size());
}

}  // namespace

void check_rays_writable(const std::string& prefix) {
    check_writable(file_of(prefix, 0));
}

template <class T>
void save_rays(const RenderArguments& a, const PathScene<T>& scene, PathPictureOptions options,
               std::uint32_t samples) {
    options.samples = samples;
    const auto bounces = [&] {
        ProgressLine line("recording rays", a.quiet, "paths");
        return rays_by_bounce(scene, options, most_paths, line.progress());
    }();
    for (std::size_t k = 0; k < bounces.size(); ++k) {
        save(file_of(a.save_rays, k), bounces[k].rays);
        if (!bounces[k].shadow_rays.empty()) save(file_of(a.save_rays, k, "-shadow"), bounces[k].shadow_rays);
    }
    if (a.quiet) return;
    const std::uint64_t paths =
        std::uint64_t(options.width) * std::uint64_t(options.height) * options.samples;
    fmt::print(stderr, "hedgerow: {} to {}: rays of {} of {} paths, by bounce\n", file_of(a.save_rays, 0),
               file_of(a.save_rays, bounces.size() - 1), bounces[0].rays.size(), paths);
}
template void save_rays(const RenderArguments&, const PathScene<float>&, PathPictureOptions, std::uint32_t);
template void save_rays(const RenderArguments&, const PathScene<double>&, PathPictureOptions, std::uint32_t);

measure::RaySet load_rays(const std::string& file) {
    using Rows = RowsOf<Ray3f>;
    const std::size_t columns = Rows::columns().size();
    const auto reader = open_rows<float>(file, row_format(file), Rows::columns());
    measure::RaySet set{std::filesystem::path(file).stem().string(), {}};
    std::vector<float> numbers;
    while (const std::size_t rows = reader->read(numbers, std::size_t(1) << 16))
        for (std::size_t i = 0; i < rows; ++i) {
            const float* const row = &numbers[columns * i];
            if (!Rows::usable(row))
                throw InputError(
                    fmt::format("{}: row {} is no ray: a number is not finite, or the origin is "
                                "farther than 2^60 from 0",
                                file, set.rays.size()));
            set.rays.push_back(Rows::of(row, {}));
        }
    if (set.rays.empty()) throw InputError(file + ": has no rays");
    set.coherent = coherent(set.rays);
    return set;
}

}  // namespace hedgerow::cli
