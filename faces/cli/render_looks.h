/// Pictures of scenes with their looks.
#pragma once

#include "rendering.h"

namespace hedgerow::cli {

/// Renders a scene with its looks, by rays through an index of two levels, or by its triangles. T is float or
/// double. Returns the exit code.
template <class T>
int render_looks(const RenderArguments& a);

/// Throws UsageError for options that no sheet of pictures has, and MemoryShort as check_picture_memory does.
void check_sheet(const RenderArguments& a);

}  // namespace hedgerow::cli
