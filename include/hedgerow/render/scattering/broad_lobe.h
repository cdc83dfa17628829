/// Light that leaves a surface in all directions: from matter below it, and from between its microfacets
/// after it met several.
#pragma once

#include <algorithm>
#include <cmath>

#include <hedgerow/render/scattering/compensation.h>
#include <hedgerow/render/scattering/surface_material.h>

namespace hedgerow {

/// The matte base of a surface, and the compensation of all its shares. o[2] is above 0 in all functions.
///
/// The base has base/π times what its coat lets through on both ways. Appendix B of glTF 2.0 takes 1 − F(o·h)
/// for that, by which a white surface reflects up to twice the light at grazing directions, and leaves it to
/// implementations to do better. Here it is (1 − A(o))(1 − A(i))/(1 − A̅) with the albedo A of the coat, and
/// its mean A̅ (Kelemen and Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
/// importance sampling, Eurographics 2001): reciprocal, and the sum of coat and base reflects A + base·(1 −
/// A). Rough coats without tables, whose A is not known, have (1 − F(o))(1 − F(i)), which is a little dark.
class BroadLobe {
public:
    /// Borrows all but o.
    BroadLobe(const SurfaceParts& parts, const Vec3f& o, const Compensation* tables)
        : parts_(parts), tables_(parts.mirror ? nullptr : tables), matte_(parts.base * parts.opaque) {
        const bool reflects = parts.metal > 0 || parts.has_coat() || (parts.through > 0 && parts.thin);
        uses_albedo_ = parts.has_coat() || (tables_ && reflects);
        if (uses_albedo_) set_surface(o);
        if (tables_ && parts.through > 0 && !parts.thin && !parts.straight()) set_glass(o);
    }

    /// The value times |cos|.
    Vec3f value(const Vec3f& i) const {
        const float cosine = std::abs(i[2]);
        Vec3f light = i[2] > 0 ? matte_ : Vec3f();
        if (uses_albedo_) {
            const GgxAlbedo albedo = albedo_at(cosine);
            if (i[2] > 0) light = light * let_in(albedo);
            light += (i[2] > 0 ? again_up_ : again_down_) * (1 - albedo.white);
        }
        if (has_glass_) {
            const float eta = i[2] > 0 ? parts_.eta : 1 / parts_.eta;
            const float lost = 1 - tables_->glass(parts_.roughness, cosine, eta);
            light += (i[2] > 0 ? Vec3f::all(glass_up_) : glass_down_) * lost;
        }
        return light * product(cosine, inverse_pi_f);
    }
    /// Estimates of what becomes of white light from everywhere: the light that the base reflects, and that
    /// which microfacets send up and down after several reflections, without the factor of radiance. A
    /// light of 0 means that there is none.
    Vec3f matte_albedo() const { return matte_ * let_in_average_; }
    Vec3f again_albedo_up() const {
        return again_up_ * lost_average_ + Vec3f::all(product(glass_up_, glass_lost_up_));
    }
    Vec3f again_albedo_down() const {
        const float eta2 = product(parts_.eta, parts_.eta);
        return again_down_ * lost_average_ + glass_down_ * product(glass_lost_down_, eta2);
    }

private:
    /// Below this mean loss there is nothing worth giving back, and quotients of losses are noise.
    static constexpr float least_loss = 1e-5f;

    GgxAlbedo albedo_at(float cosine) const {
        return tables_ ? tables_->ggx(parts_.roughness, cosine) : GgxAlbedo::of_mirror(cosine);
    }
    /// The light of many reflections over the light that one reflection loses, for a mean reflectance:
    /// F² E/(1 − F(1 − E)), a geometric series.
    static Vec3f again(const Vec3f& fresnel, float white) {
        return map(fresnel,
                   [white](float f) { return product(product(f, f), white) / (1 - product(f, 1 - white)); });
    }
    void set_surface(const Vec3f& o) {
        const GgxAlbedo at_o = albedo_at(o[2]), mean = tables_ ? tables_->ggx_average(parts_.roughness)
                                                               : GgxAlbedo::of_mirror_average();
        lost_average_ = 1 - mean.white;
        if (tables_ && lost_average_ > least_loss) {
            again_coat_ = max_component(again(parts_.coat.average(), mean.white));
            const float scale = (1 - at_o.white) / lost_average_;
            again_up_ = again(parts_.metal_fresnel.average(), mean.white) * product(parts_.metal, scale) +
                        again(parts_.coat.average(), mean.white) * product(parts_.opaque, scale);
            if (parts_.through > 0 && parts_.thin) set_thin(product(parts_.through, scale));
        }
        if (!parts_.has_coat()) return;
        let_in_average_ = let_in(mean);
        // Rough coats without tables are not normalised: their albedo is less than that of a mirror.
        const float mean_let_in = tables_ || parts_.mirror ? let_in_average_ : 1.0f;
        matte_ = matte_ * (mean_let_in > least_loss ? let_in(at_o) / mean_let_in : 0.0f);
    }
    void set_thin(float share) {
        const Vec3f fresnel = parts_.coat.average();
        again_up_ += fresnel * share;
        again_down_ = parts_.base * product(share, 1 - max_component(fresnel));
    }
    /// What is not reflected by the coat, in the colour that it reflects most.
    float let_in(const GgxAlbedo& albedo) const {
        if (!parts_.has_coat()) return 1;
        const float once = max_component(albedo.with(parts_.coat));
        return std::max(1 - once - product(again_coat_, 1 - albedo.white), 0.0f);
    }
    /// Divides the loss of glass between both sides, so that what goes through is reciprocal: b(o)·D̅(o)·η_o²
    /// is alike from both sides for b(o) = T̅(o)·min(D̅(o), D̅(i))/D̅(o), where T̅ is the share that a smooth
    /// surface refracts, and D̅ the mean loss. The rest, 1 − b, is reflected.
    void set_glass(const Vec3f& o) {
        const float r = parts_.roughness, eta = parts_.eta;
        glass_lost_up_ = 1 - tables_->glass_average(r, eta);
        glass_lost_down_ = 1 - tables_->glass_average(r, 1 / eta);
        has_glass_ = std::min(glass_lost_up_, glass_lost_down_) > least_loss;
        if (!has_glass_) return;
        const float refracts = product(tables_->refracted_average(eta),
                                       std::min(glass_lost_up_, glass_lost_down_) / glass_lost_up_);
        const float lost = product(parts_.through, 1 - tables_->glass(r, o[2], eta));
        glass_up_ = product(lost, 1 - refracts) / glass_lost_up_;
        const float radiance = 1 / product(eta, eta);
        glass_down_ = parts_.base * (product(product(lost, refracts), radiance) / glass_lost_down_);
    }

    const SurfaceParts& parts_;
    const Compensation* tables_;  // null where nothing is lost
    bool uses_albedo_ = false, has_glass_ = false;
    Vec3f matte_;
    float let_in_average_ = 1;
    Vec3f again_up_, again_down_;  // times the loss at i
    float again_coat_ = 0, lost_average_ = 0;
    float glass_up_ = 0, glass_lost_up_ = 0, glass_lost_down_ = 0;
    Vec3f glass_down_;
};

}  // namespace hedgerow
