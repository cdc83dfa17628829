#include "build_any.h"

namespace hedgerow {
HEDGEROW_BUILD_ANY(double)
}  // namespace hedgerow
