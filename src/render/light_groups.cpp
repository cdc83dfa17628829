#include <hedgerow/render/lighting/light_groups.h>

#include "light_kernels.h"

hedgerow::LightGroups::Lanes hedgerow::LightGroups::importances(const Vec3f& point,
                                                                const Vec3f& receiver) const {
    Lanes found;
    if (const LightKernels* const kernels = light_kernels())
        kernels->write_importances(*this, point, receiver, found.data());
    else
        write_importances(*this, point, receiver, found.data());
    return found;
}
