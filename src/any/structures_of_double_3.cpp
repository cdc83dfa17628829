#include "structure_of.h"

namespace hedgerow::detail {
template std::unique_ptr<StructureBehind<double, 3>> build_structure(std::string_view,
                                                                     const AnySet<double, 3>&, Executor&);
}  // namespace hedgerow::detail
