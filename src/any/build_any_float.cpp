#include "build_any.h"

namespace hedgerow::detail {
HEDGEROW_BUILD_ANY(float)
}  // namespace hedgerow::detail
