/// Makes pictures out of their parts: a camera, what is visible, how that is shaded, and the film. The
/// component `render` has it compiled.
#pragma once

#include <cstdint>

#include <hedgerow/parallel/by.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/render/film/film.h>
#include <hedgerow/render/shading/appearance.h>
#include <hedgerow/render/shading/shading.h>
#include <hedgerow/render/shading/surfaces.h>
#include <hedgerow/render/tracer.h>
#include <hedgerow/render/visibility/cast.h>
#include <hedgerow/render/visibility/cones.h>

namespace hedgerow {

struct RenderOptions {
    Camera camera;
    int width = 1024, height = 768, samples = 1;
    Shading shading = Shading::diffuse;
    std::uint64_t seed = 0;
    HeatScale scale;
    /// Whether the picture stores the hits of its rays, for `Picture::layers`.
    bool layers = false;
    /// Whether the visits of rays are counted, which rules out the kernels. Layers and the shadings `steps`
    /// and `tests` imply it.
    bool counts = false;
    /// Whether surfaces let light through that are not opaque: layers are composited front to back
    /// (shading/transparency.h), in shadows too. The opacity is that of the appearances, if there are some,
    /// times `opacity`. Visits are then those up to the first hit.
    bool transparent = false;
    float opacity = 1;
    TransparencyOptions transparency;
    /// Whether a cone sees each pixel as a whole (visibility/cones.h), in place of samples: edges are smooth.
    /// Layers are then those of its nearest surface.
    bool cones = false;
    /// Whether the textures of the shading `colour` are averaged over what a sample's share of its pixel sees
    /// of them, in place of a lookup at a point, so that fine patterns turn into their mean, not into noise.
    bool footprints = false;
    /// Whether pixels get all their samples only where light differs much (film/contrast.h): the first four
    /// decide for the others. Pixels that get all have the bits of a picture that is not refined.
    bool refines = false;
    /// The diameter of the distant light in degrees, less than 90. Shadows of a disc have soft edges, for
    /// which a cone goes to the light in place of a ray. 0 is a light without extent.
    float light_degrees = 0;
    /// By which threads. What is answered does not depend on them.
    Threads threads = {};

    bool counted() const { return counts || layers || counts_visits(shading); }
};

/// What a picture is made from. All of it is borrowed.
template <std::floating_point T>
struct PictureParts {
    Visibility<T>& visibility;
    const Surfaces<T>& surfaces;
    /// Answers the rays to the light of lit shadings, those through transparent surfaces, and those that are
    /// timed; other pictures need none.
    const Tracer<T>* tracer = nullptr;
    /// What surfaces look like, for the shading `colour`, and their opacity, for transparent ones. Its masks
    /// hold for rays to the light; what finds the visible has to be given them too.
    const Appearances<T>* appearances = nullptr;
    /// Answers the cones of pixels and of soft shadows; other pictures need none.
    const Cones<T>* cones = nullptr;
};

/// Makes a picture, in tiles of pixels. Diffuse shading and that by colour cast a ray to the light where the
/// surface faces it. Returns when all rows are finished or the progress is cancelled:
/// then rows that are not finished stay black, and their layers empty. Throws InputError for a camera that
/// sees nothing, no pixels or samples, an opacity that is not 0 to 1, where the picture needs a tracer, cones
/// or appearances and there are none, where it shows costs of rays but what is visible is found without them,
/// through transparent surfaces, or refined, and for cones of transparent surfaces, of more samples than one,
/// or of a lens, and for footprints in a panorama.
template <std::floating_point T>
Picture render(const PictureParts<T>& parts, const RenderOptions& options, const Progress& progress = {});
extern template Picture render(const PictureParts<float>&, const RenderOptions&, const Progress&);
extern template Picture render(const PictureParts<double>&, const RenderOptions&, const Progress&);

/// Makes a picture by casting rays at an index (of any structure) over `primitives`.
template <class I, class P>
Picture render(const I& index, const P& primitives, const RenderOptions& options,
               const Progress& progress = {}) {
    using T = typename I::Scalar;
    const IndexTracer<I> tracer(index);
    const SurfacesOf<P> surfaces(primitives);
    RayCasting<T> casting(tracer);
    return render(PictureParts<T>{casting, surfaces, &tracer}, options, progress);
}

}  // namespace hedgerow
