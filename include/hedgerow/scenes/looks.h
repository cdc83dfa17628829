/// Generated scenes with their looks.
#pragma once

#include <hedgerow/looks/model.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/scenes/generate.h>

namespace hedgerow {

/// Makes a scene of triangles as a model of one object, whose mesh is that of `generate`.
///
/// The Cornell box has its measured reflectances and light, as linear colours with the primaries of sRGB: of
/// the spectra in "Cornell Box Data" (Cornell University Program of Computer Graphics, 1998) and the CIE 1931
/// observer, from 400 to 700 nm. A reflectance is weighed with CIE D65, component by component beside a
/// surface that reflects all. The light's radiance is such that a spectrum of 1 has luminance 1; it has no
/// unit in the data. Materials of other scenes are made up: glazed pots, concrete, earth, blades, hair and
/// stone. The triangles of the soup have six colours in turn.
///
/// Throws as `generate` does, and UsageError for a scene that has no triangles. T is float or double.
/// O(size).
template <class T>
Model<T> generate_model(const SceneSpec& spec, const Progress& progress = {});

}  // namespace hedgerow
