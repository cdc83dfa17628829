/// Files of rays: those of a render, which `bench` and `query` read.
#pragma once

#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/render/integrators/path_picture.h>

#include "rendering.h"

namespace hedgerow::cli {

/// Saves the rays of a picture's paths, if it has so many samples a pixel: those after k bounces as
/// PREFIX-k.npy, and those to lights from where these hit as PREFIX-k-shadow.npy, in rows of `hedgerow
/// query`. They are the rays of at most a million paths (rays_by_bounce). Says so, unless it is to be quiet.
/// Throws OutputError, and Cancelled at Ctrl-C.
template <class T>
void save_rays(const RenderArguments& a, const PathScene<T>& scene, PathPictureOptions options,
               std::uint32_t samples);
/// Throws OutputError if the rays could not be saved.
void check_rays_writable(const std::string& prefix);

/// Reads rows of rays. The set is named as the file without its extension. Throws InputError for a file
/// without rays, and for a row that is no ray.
measure::RaySet load_rays(const std::string& file);

}  // namespace hedgerow::cli
