/// What the parts of the verb `render` share: its arguments, the options of the picture, and the report.
#pragma once

#include <hedgerow/render/render.h>

#include "common.h"
#include "upright.h"
#include "view.h"

namespace hedgerow::cli {

struct RenderArguments : Common {
    std::string structure = "wide", shading = "diffuse", visibility = "cast";
    ViewArguments view;
    int spp = 1;
    unsigned threads = 0;
    std::uint64_t steps_max = 0;
    int camera = -1;    // of the file
    float opacity = 1;  // of all surfaces, times that of their looks
    bool transparent = false, sheet = false;
    std::uint32_t bounces = 64;                                      // of paths
    std::string sampler = "sobol", filter = "box", tone = "linear";  // of paths
    float exposure = 0;                                              // of paths, in powers of two
    double seconds = 0;          // that paths are followed; 0: until all samples are there
    std::string resume;          // the file of a state of paths
    double noise = 0;            // at which paths end; 0: they end by number
    bool adaptive = false;       // samples of paths
    bool shows_samples = false;  // in place of light
    bool preview = false;        // of paths, in the terminal
    bool denoises = false;       // pictures of paths
    std::string environment;     // the file of a panorama that lights paths
    double environment_rotation = 0, environment_strength = 1;  // in degrees; a factor
    std::string save_rays;                                      // the prefix of files for rays of paths
    bool footprints = false;                                    // of textures
    bool refines = false;                                       // where samples differ
    bool cones = false;                                         // in place of samples
    float light_degrees = 0;                                    // the diameter of the light
    bool counts = false, layers = false;                        // layers: whether the output is .exr

    bool rasterises() const { return visibility == "raster"; }
    bool follows_paths() const { return shading == "path"; }
    /// How rays from the eye are shaded; paths, which have light of their own, are given the default.
    Shading shading_of_rays() const { return named_shading(shading).value_or(Shading::diffuse); }
    bool uses_beams() const { return visibility == "beams"; }
    bool uses_cones() const { return cones || light_degrees > 0; }
    /// Whether the picture needs an index: for its rays from the eye, through surfaces, or to the light.
    bool needs_index() const { return !rasterises() || transparent || is_lit(shading_of_rays()); }
};

struct Outcome {
    Picture picture;
    std::size_t primitives = 0, bytes = 0;
    Upright upright{2, ""};
    Vec3f up;
    FinishedPicture finished;
    bool indexed = false, loaded = false;  // whether there is an index, and whether it was loaded, not built
    bool counted = false;                  // visits of rays were counted
    double build_seconds = 0, seconds = 0;
};

/// The picture's options, with the camera placed by the bounds of the scene.
RenderOptions options_of(const RenderArguments& a, const Box3f& bounds, const Upright& upright);

/// Saves the picture, and prints what it took, as text or JSON. After an interruption the finished rows are
/// saved. Returns the exit code.
int save_and_report(const RenderArguments& a, Outcome o);
/// Makes the picture, saves it and reports.
template <class T>
int finish(const RenderArguments& a, const PictureParts<T>& parts, const RenderOptions& options, Outcome o,
           const Progress& progress) {
    o.counted = options.counted(), o.up = options.camera.up;
    const double start = now();
    o.picture = render(parts, by(default_executor(), options), progress);
    o.seconds = now() - start;
    return save_and_report(a, std::move(o));
}

}  // namespace hedgerow::cli
