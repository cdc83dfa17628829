#include <hedgerow/render/lighting/light_groups.h>

#include "light_kernels.h"

hedgerow::LightGroups::Lanes hedgerow::LightGroups::importances(const Vec3f& point,
                                                                const Vec3f& receiver) const {
    Lanes found;
    const LightKernels* const kernels = in_use<LightKernels>();
    const auto write = kernels ? kernels->write_importances : write_importances;
    write(*this, point, receiver, found.data());
    return found;
}
