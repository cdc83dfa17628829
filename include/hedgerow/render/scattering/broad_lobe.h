/// Light that leaves a surface in all directions: from matter below it, and from between its microfacets
/// after it met several.
#pragma once

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
template <class F>
class BroadLobe {
    using Mask = MaskOf<F>;
    using Colour = Vec<F, 3>;

public:
    /// Borrows all but o.
    BroadLobe(const SurfacePartsOf<F>& parts, const Vec<F, 3>& o, const Compensation* tables)
        : parts_(parts),
          tables_(tables),
          loses_(Mask(tables != nullptr) && !parts.mirror),
          matte_(parts.base * parts.opaque) {
        const Mask through = parts.through > 0;
        const Mask reflects = parts.metal > 0 || parts.has_coat() || (through && parts.thin);
        uses_albedo_ = parts.has_coat() || (loses_ && reflects);
        if (any(uses_albedo_)) set_surface(o);
        const Mask refracts = loses_ && through && !parts.thin && !parts.straight();
        if (any(refracts)) set_glass(o, refracts);
    }

    /// The value times |cos|.
    Colour value(const Vec<F, 3>& i) const {
        const Mask up = i[2] > 0;
        const F cosine = magnitude(i[2]);
        Colour light = only(up, matte_);
        if (any(uses_albedo_)) {
            const GgxAlbedo<F> albedo = albedo_at(cosine);
            const Colour coated = select(up, light * let_in(albedo), light);
            light =
                select(uses_albedo_, coated + select(up, again_up_, again_down_) * (1 - albedo.white), light);
        }
        if (any(has_glass_)) {
            const F eta = select(up, parts_.eta, 1 / parts_.eta);
            const F lost = 1 - tables_->glass(parts_.roughness, cosine, eta);
            const Colour again = select(up, Colour::all(glass_up_), glass_down_) * lost;
            light = select(has_glass_, light + again, light);
        }
        return light * product(cosine, inverse_pi_f);
    }
    /// Estimates of what becomes of white light from everywhere: the light that the base reflects, and that
    /// which microfacets send up and down after several reflections, without the factor of radiance. A
    /// light of 0 means that there is none.
    Colour matte_albedo() const { return matte_ * let_in_average_; }
    Colour again_albedo_up() const {
        return again_up_ * lost_average_ + Colour::all(product(glass_up_, glass_lost_up_));
    }
    Colour again_albedo_down() const {
        const F eta2 = product(parts_.eta, parts_.eta);
        return again_down_ * lost_average_ + glass_down_ * product(glass_lost_down_, eta2);
    }

private:
    /// Below this mean loss there is nothing worth giving back, and quotients of losses are noise.
    static constexpr float least_loss = 1e-5f;

    /// The albedo by the tables where microfacets lose light, else that of a mirror.
    GgxAlbedo<F> albedo_at(F cosine) const {
        const auto mirror = GgxAlbedo<F>::of_mirror(cosine);
        return any(loses_) ? by_loss(tables_->ggx(parts_.roughness, cosine), mirror) : mirror;
    }
    GgxAlbedo<F> mean_albedo() const {
        const auto mirror = GgxAlbedo<F>::of_mirror_average();
        return any(loses_) ? by_loss(tables_->ggx_average(parts_.roughness), mirror) : mirror;
    }
    GgxAlbedo<F> by_loss(const GgxAlbedo<F>& rough, const GgxAlbedo<F>& mirror) const {
        return {select(loses_, rough.white, mirror.white), select(loses_, rough.grazing, mirror.grazing)};
    }
    /// The light of many reflections over the light that one reflection loses, for a mean reflectance:
    /// F² E/(1 − F(1 − E)), a geometric series.
    static Colour again(const Colour& fresnel, F white) {
        return map(fresnel,
                   [white](F f) { return product(product(f, f), white) / (1 - product(f, 1 - white)); });
    }
    void set_surface(const Vec<F, 3>& o) {
        const GgxAlbedo<F> at_o = albedo_at(o[2]), mean = mean_albedo();
        lost_average_ = only(uses_albedo_, 1 - mean.white);
        if (const Mask gives_back = loses_ && lost_average_ > least_loss; any(gives_back)) {
            const Colour of_coat = again(parts_.coat.average(), mean.white);
            again_coat_ = only(gives_back, max_component(of_coat));
            const F scale = only(gives_back, (1 - at_o.white) / lost_average_);
            again_up_ = again(parts_.metal_fresnel.average(), mean.white) * product(parts_.metal, scale) +
                        of_coat * product(parts_.opaque, scale);
            const F thin = only(parts_.thin, product(parts_.through, scale));
            if (any(thin > 0)) set_thin(thin);
        }
        const Mask coat = parts_.has_coat();
        if (!any(coat)) return;
        let_in_average_ = let_in(mean);
        // Rough coats without tables are not normalised: their albedo is less than that of a mirror.
        const F mean_let_in = select(loses_ || parts_.mirror, let_in_average_, 1);
        const F share = only(mean_let_in > least_loss, let_in(at_o) / mean_let_in);
        matte_ = select(coat, matte_ * share, matte_);
    }
    void set_thin(F share) {
        const Colour fresnel = parts_.coat.average();
        again_up_ += fresnel * share;
        again_down_ = parts_.base * product(share, 1 - max_component(fresnel));
    }
    /// What is not reflected by the coat, in the colour that it reflects most.
    F let_in(const GgxAlbedo<F>& albedo) const {
        if (!any(parts_.has_coat())) return 1;
        const F once = max_component(albedo.with(parts_.coat));
        return select(parts_.has_coat(), greater(1 - once - product(again_coat_, 1 - albedo.white), 0), 1);
    }
    /// Divides the loss of glass between both sides, so that what goes through is reciprocal: b(o)·D̅(o)·η_o²
    /// is alike from both sides for b(o) = T̅(o)·min(D̅(o), D̅(i))/D̅(o), where T̅ is the share that a smooth
    /// surface refracts, and D̅ the mean loss. The rest, 1 − b, is reflected.
    void set_glass(const Vec<F, 3>& o, Mask refracts) {
        const F r = parts_.roughness, eta = parts_.eta;
        glass_lost_up_ = 1 - tables_->glass_average(r, eta);
        glass_lost_down_ = 1 - tables_->glass_average(r, 1 / eta);
        const F least = lesser(glass_lost_up_, glass_lost_down_);
        has_glass_ = refracts && least > least_loss;
        if (!any(has_glass_)) return;
        const F goes_on = product(tables_->refracted_average(eta), least / glass_lost_up_);
        const F lost = product(parts_.through, 1 - tables_->glass(r, o[2], eta));
        glass_up_ = only(has_glass_, product(lost, 1 - goes_on) / glass_lost_up_);
        const F radiance = 1 / product(eta, eta);
        glass_down_ =
            only(has_glass_, parts_.base * (product(product(lost, goes_on), radiance) / glass_lost_down_));
    }

    const SurfacePartsOf<F>& parts_;
    const Compensation* tables_;
    Mask loses_;  // whether microfacets lose light that is given back
    Mask uses_albedo_{false}, has_glass_{false};
    Colour matte_;
    F let_in_average_ = 1;
    Colour again_up_, again_down_;  // times the loss at i
    F again_coat_ = 0, lost_average_ = 0;
    F glass_up_ = 0, glass_lost_up_ = 0, glass_lost_down_ = 0;
    Colour glass_down_;
};

}  // namespace hedgerow
