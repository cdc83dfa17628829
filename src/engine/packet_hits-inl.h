/// The hits of a packet's rays so far, and the test of its rays against the triangles of a leaf. A filter in
/// floats comes first: each ray against all triangles, or all rays against each triangle. The exact test of
/// the pairs that pass follows.
#if defined(HEDGEROW_ENGINE_PACKET_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_PACKET_HITS_INL_H
#undef HEDGEROW_ENGINE_PACKET_HITS_INL_H
#else
#define HEDGEROW_ENGINE_PACKET_HITS_INL_H
#endif

#include <algorithm>
#include <bit>

#include <hwy/highway.h>

#include "packet_rays-inl.h"
#include "tests-inl.h"
#include "walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <Wanted wanted>
struct PacketHits : PacketRays {
    alignas(64) float u[size], v[size];  // of the hit so far; its t is t_limit
    alignas(64) std::uint32_t element[size];

    /// Resets all rays to no hit.
    HWY_INLINE void clear_hits() { std::fill_n(element, size, Hit<float>::none); }
    /// Tests the active rays (a bit each) against a block. True if one of them was hit. If few rays are
    /// active, testing each against eight triangles is less work than testing all rays against each
    /// triangle.
    HWY_INLINE bool test_leaf(const WideScene& scene, const TriangleBlock<float>& block,
                              std::uint64_t active) {
        if (std::popcount(active) > few) return test_triangles(scene, block, active);
        const int pairs = common_origin ? hold_rays<true>(block, active) : hold_rays<false>(block, active);
        return meet_all_pairs(scene, block, pairs);
    }
    /// Tests each triangle of a block against rays of its own (a bit each): the filter on a vector of rays
    /// after the other, and the exact test on those that pass it, in their vector if it holds many, else pair
    /// by pair. True if a ray was hit.
    HWY_INLINE bool test_each(const WideScene& scene, const TriangleBlock<float>& block,
                              const std::uint64_t (&active)[8]) {
        alignas(64) float corner[3][3][8];
        constexpr std::uint64_t every = (std::uint64_t(1) << lanes) - 1;
        int pairs = 0;
        bool found = false;
        for (unsigned left = seen_of<false>(block, corner); left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            for (std::uint64_t rays = active[i]; rays != 0;) {
                const int at = std::countr_zero(rays) / lanes * lanes;
                const auto corners = corners_of(corner, i, at);
                const M kept = corners.may_meet(f, hn::Load(f, z + at), hn::Load(f, s_low + at),
                                                hn::Load(f, s_limit + at));
                unsigned some = static_cast<unsigned>(rays >> at & every) & bits_of(f, kept);
                rays &= ~(every << at);
                if (std::popcount(some) > few_lanes)
                    found |= meet(scene, corners, block.id[i], at, some);
                else
                    for (; some != 0; some &= some - 1)
                        pair_[pairs++] = i * size + at + std::countr_zero(some);
            }
        }
        return meet_all_pairs(scene, block, pairs) || found;
    }

private:
    static constexpr int few = 32, few_lanes = lanes / 4;
    using E = Floats<8>;
    static constexpr E e{};
    static constexpr hn::RebindToSigned<F> i32{};
    static constexpr hn::RebindToSigned<E> pair_i32{};
    static constexpr int pair_lanes = static_cast<int>(hn::MaxLanes(e));

    // ---- Each ray against all triangles ----

    /// One ray in all lanes. Where there are 16 lanes, two rays with 8 lanes each.
    struct Held {
        int low, high;

        static HWY_INLINE M upper() { return hn::Not(hn::FirstN(f, 8)); }
        HWY_INLINE V operator()(const float* of) const {
            const V x = hn::Set(f, of[low]);
            if constexpr (lanes < 16)
                return x;
            else
                return hn::IfThenElse(upper(), hn::Set(f, of[high]), x);
        }
        HWY_INLINE hn::Vec<decltype(i32)> numbers() const {
            const auto x = hn::Set(i32, low);
            if constexpr (lanes < 16)
                return x;
            else
                return hn::IfThenElse(hn::RebindMask(i32, upper()), hn::Set(i32, high), x);
        }
    };
    /// The eight floats of a row, twice in a vector of 16 lanes. A vector of fewer lanes gets those from
    /// `at` on.
    static HWY_INLINE V eight(const float* row, int at) {
        if constexpr (lanes == 16) {
            const auto x = hn::Load(hn::Half<F>(), row);
            return hn::Combine(f, x, x);
        } else {
            return hn::Load(f, row + at);
        }
    }
    /// The interval of a triangle along the rays' longest axis, in their direction.
    HWY_INLINE void reach_of(const V (&along)[3], V& near, V& far) const {
        near = hn::Min(along[0], hn::Min(along[1], along[2]));
        far = hn::Max(along[0], hn::Max(along[1], along[2]));
        if (!down[z_axis]) return;
        const V nearer = hn::Neg(far);
        far = hn::Neg(near), near = nearer;
    }
    /// Writes the pairs (triangle · 64 + ray) that the filter keeps, and returns their number.
    template <bool from_one_origin>
    HWY_INLINE int hold_rays(const TriangleBlock<float>& block, std::uint64_t active) {
        int pairs = 0;
        for (int at = 0; at < 8; at += std::min(lanes, 8)) {
            // The corners, relative to the origin if the rays share it, and the number of the triangle in
            // each lane.
            V corner[3][3], near, far;
            for (int k = 0; k < 3; ++k)
                for (int c = 0; c < 3; ++c) {
                    corner[k][c] = eight(block.corner[axis[k]][c], at);
                    if constexpr (from_one_origin)
                        corner[k][c] = hn::Sub(corner[k][c], hn::Set(f, origin[k][0]));
                }
            if constexpr (from_one_origin) reach_of(corner[2], near, far);
            const auto triangle = hn::And(hn::Iota(i32, at), hn::Set(i32, 7));
            for (std::uint64_t left = active; left != 0;) {
                // The next active ray. A vector of 16 lanes takes the next two.
                Held ray;
                ray.low = ray.high = std::countr_zero(left);
                left &= left - 1;
                if (lanes == 16 && left != 0) {
                    ray.high = std::countr_zero(left);
                    left &= left - 1;
                }
                // Filter by the triangle's edges and by its interval along the ray.
                const auto from_origin = [&](int k, int c) {
                    if constexpr (from_one_origin)
                        return corner[k][c];
                    else
                        return hn::Sub(corner[k][c], ray(origin[k]));
                };
                const ShearedCorners<F> corners(from_origin, ray(shear[0]), ray(shear[1]));
                if constexpr (!from_one_origin) reach_of(corners.z, near, far);
                M kept =
                    hn::And(corners.around(f), hn::And(hn::Le(near, ray(s_limit)), hn::Ge(far, ray(s_low))));
                // A single ray in a vector for two is in both halves: count it once.
                if (lanes == 16 && ray.low == ray.high) kept = hn::And(kept, hn::FirstN(f, 8));
                add_pairs(kept, hn::Add(hn::ShiftLeft<6>(triangle), ray.numbers()), pairs);
            }
        }
        return pairs;
    }
    HWY_INLINE void add_pairs(M kept, hn::Vec<decltype(i32)> pair, int& pairs) {
        if constexpr (compresses) {
            hn::StoreU(compressed(i32, pair, hn::RebindMask(i32, kept)), i32, pair_ + pairs);
            pairs += static_cast<int>(hn::CountTrue(f, kept));
        } else if (unsigned left = bits_of(f, kept)) {
            alignas(64) std::int32_t each[lanes];
            hn::Store(pair, i32, each);
            for (; left != 0; left &= left - 1) pair_[pairs++] = each[std::countr_zero(left)];
        }
    }
    HWY_INLINE bool meet_all_pairs(const WideScene& scene, const TriangleBlock<float>& block, int pairs) {
        bool found = false;
        for (int at = 0; at < pairs; at += pair_lanes)
            found |= meet_pairs(scene, block, pair_ + at, std::min(pairs - at, pair_lanes));
        return found;
    }
    /// The exact test of `count` pairs. True if a ray was hit.
    HWY_INLINE bool meet_pairs(const WideScene& scene, const TriangleBlock<float>& block,
                               const std::int32_t* pairs, int count) {
        // Gather the pairs in lanes: triangles relative to their rays.
        const auto some = hn::FirstN(pair_i32, static_cast<std::size_t>(count));
        const auto pair = hn::IfThenElseZero(some, hn::LoadU(pair_i32, pairs));
        const auto ray = hn::And(pair, hn::Set(pair_i32, size - 1)), triangle = hn::ShiftRight<6>(pair);
        const auto from_origin = [&](int k, int c) {
            const auto o = common_origin ? hn::Set(e, origin[k][0]) : hn::GatherIndex(e, origin[k], ray);
            return hn::Sub(picked(block.corner[axis[k]][c], triangle), o);
        };
        const ShearedCorners<E> corners(from_origin, hn::GatherIndex(e, shear[0], ray),
                                        hn::GatherIndex(e, shear[1], ray));
        alignas(64) float along[pair_lanes];
        hn::Store(hn::GatherIndex(e, z, ray), e, along);
        const auto direction_z = [&](auto d, int i) {
            return hn::PromoteTo(d, hn::Load(hn::Rebind<float, decltype(d)>(), along + i));
        };
        // Test exactly. Then store hits one by one, since several pairs may be of one ray.
        Meetings m;
        unsigned met = meet_exactly_among(e, corners, (1u << count) - 1, direction_z, m);
        bool found = false;
        for (; met != 0; met &= met - 1) {
            const int i = std::countr_zero(met), r = pairs[i] & (size - 1);
            const std::uint32_t id = block.id[pairs[i] >> 6];
            if (!nearer(m.t[i], id, t_min[r], t_limit[r], element[r])) continue;
            if (scene.filter.keeps != nullptr) [[unlikely]]
                if (!kept_alone(scene, m, i, r, id)) continue;
            t_limit[r] = m.t[i], u[r] = m.u[i], v[r] = m.v[i], element[r] = id;
            s_limit[r] = wanted == Wanted::any ? -1.0f : s_limit_of(m.t[i], z_length[r]);
            found = true;
        }
        return found;
    }
    /// The floats with these numbers, of a row of eight.
    static HWY_INLINE hn::Vec<E> picked(const float* row, hn::Vec<decltype(pair_i32)> numbers) {
        if constexpr (pair_lanes == 8)
            return hn::TableLookupLanes(hn::Load(e, row), hn::IndicesFromVec(e, numbers));
        else
            return hn::GatherIndex(e, row, numbers);
    }

    // ---- All rays against each triangle ----

    HWY_INLINE bool test_triangles(const WideScene& scene, const TriangleBlock<float>& block,
                                   std::uint64_t active) {
        alignas(64) float corner[3][3][8];  // by the rays' axes; relative to the origin if they share it
        const unsigned triangles = seen_of<true>(block, corner);
        // Filter: all rays against each triangle that some ray may meet.
        std::uint64_t candidates[8];
        for (unsigned left = triangles; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            std::uint64_t rays = 0;
            for (int at = 0; at < size; at += lanes) {
                const M kept =
                    corners_of(corner, i, at)
                        .may_meet(f, hn::Load(f, z + at), hn::Load(f, s_low + at), hn::Load(f, s_limit + at));
                rays |= std::uint64_t(bits_of(f, kept)) << at;
            }
            candidates[i] = rays & active;
        }
        // Test the candidates exactly, a vector of rays at a time.
        bool found = false;
        for (unsigned left = triangles; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            for (std::uint64_t rays = candidates[i]; rays != 0;) {
                const int at = std::countr_zero(rays) / lanes * lanes;
                constexpr std::uint64_t every = (std::uint64_t(1) << lanes) - 1;
                found |= meet(scene, corners_of(corner, i, at), block.id[i], at,
                              static_cast<unsigned>(rays >> at & every));
                rays &= ~(every << at);
            }
        }
        return found;
    }
    /// Writes the corners by the rays' axes. Returns which triangles some ray may meet, a bit each. Rays of
    /// several origins are held against the triangles' boxes, unless the slabs are not prepared.
    template <bool has_slabs>
    HWY_INLINE unsigned seen_of(const TriangleBlock<float>& block, float (&corner)[3][3][8]) const {
        unsigned seen = 0;
        for (int at = 0; at < 8; at += static_cast<int>(hn::MaxLanes(e))) {
            hn::Vec<E> c[3][3];
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) {
                    c[k][i] = hn::Load(e, block.corner[axis[k]][i] + at);
                    if (common_origin) c[k][i] = hn::Sub(c[k][i], hn::Set(e, origin[k][0]));
                    hn::Store(c[k][i], e, corner[k][i] + at);
                }
            auto some = hn::Eq(c[0][0], c[0][0]);  // filled: not NaN
            if (common_origin)
                some = hn::And(some, around_origin(c));
            else if constexpr (has_slabs)
                some = hn::And(some, entered(c));
            seen |= bits_of(e, some) << at;
        }
        return seen;
    }
    /// For rays of one origin: false for a triangle whose corners all lie, for every ray, on the same side
    /// of it. It computes what the test of a ray computes, for the rays of least and of most shear. Rounding
    /// is monotone, so it keeps all other rays between these.
    HWY_INLINE hn::Mask<E> around_origin(const hn::Vec<E> (&c)[3][3]) const {
        auto around = hn::Eq(hn::Zero(e), hn::Zero(e));
        for (int k = 0; k < 2; ++k) {
            auto least = hn::Set(e, std::numeric_limits<float>::infinity()), most = hn::Neg(least);
            for (int i = 0; i < 3; ++i)
                for (const float by : {shears[k].low, shears[k].high}) {
                    const auto x = hn::Sub(c[k][i], hn::Mul(hn::Set(e, by), c[2][i]));
                    least = hn::Min(least, x), most = hn::Max(most, x);
                }
            around = hn::And(around, hn::And(hn::Le(least, hn::Zero(e)), hn::Ge(most, hn::Zero(e))));
        }
        return around;
    }
    /// The triangles whose boxes some ray may enter.
    HWY_INLINE hn::Mask<E> entered(const hn::Vec<E> (&c)[3][3]) const {
        auto entry = hn::Set(e, s_first), exit = hn::Set(e, s_last);
        for (int k = 0; k < 3; ++k) {
            const auto low = hn::Min(c[k][0], hn::Min(c[k][1], c[k][2]));
            const auto high = hn::Max(c[k][0], hn::Max(c[k][1], c[k][2]));
            const bool downward = down[axis[k]];
            entry = hn::Max(entry, earliest(e, axis[k], downward ? high : low));
            exit = hn::Min(exit, latest(e, axis[k], downward ? low : high));
        }
        return hn::Le(entry, exit);
    }
    HWY_INLINE ShearedCorners<F> corners_of(const float (&corner)[3][3][8], int i, int at) const {
        const auto from_origin = [&](int k, int c) {
            const V x = hn::Set(f, corner[k][c][i]);
            return common_origin ? x : hn::Sub(x, hn::Load(f, origin[k] + at));
        };
        return ShearedCorners<F>(from_origin, hn::Load(f, shear[0] + at), hn::Load(f, shear[1] + at));
    }
    /// Tests a triangle exactly against the candidates (a bit each) among the rays from `at` on. It becomes
    /// the hit of the rays that it hits nearer than before (or as near, with a lower number). True if there
    /// are any.
    HWY_INLINE bool meet(const WideScene& scene, const ShearedCorners<F>& corners, std::uint32_t id, int at,
                         unsigned candidates) {
        // Any hit: those that are sure need no exact test.
        bool found = false;
        if (wanted == Wanted::any && scene.filter.keeps == nullptr) {
            const unsigned sure =
                candidates &
                bits_of(f, corners.surely_meets(f, hn::Load(f, z + at), hn::Load(f, z_length + at),
                                                hn::Load(f, t_min + at), hn::Load(f, t_limit + at)));
            if (sure != 0) {
                found = true;
                end(sure, id, at);
                candidates ^= sure;
            }
            if (candidates == 0) return found;
        }
        Meetings m;
        const auto direction_z = [&](auto d, int from) {
            return hn::PromoteTo(d, hn::Load(hn::Rebind<float, decltype(d)>(), z + at + from));
        };
        candidates = meet_exactly_among(f, corners, candidates, direction_z, m);
        // Keep the candidates whose t lies in their interval and is better than that of their hit so far.
        const V t = hn::Load(f, m.t), limit = hn::Load(f, t_limit + at);
        const M lower = hn::RebindMask(f, hn::Lt(hn::Set(u32, id), hn::Load(u32, element + at)));
        M better = hn::And(hn::Ge(t, hn::Load(f, t_min + at)),
                           hn::Le(t, hn::Set(f, std::numeric_limits<float>::max())));
        better = hn::And(better, hn::Or(hn::Lt(t, limit), hn::And(hn::Eq(t, limit), lower)));
        candidates &= bits_of(f, better);
        if (scene.filter.keeps != nullptr) [[unlikely]]
            candidates = kept_of(scene, candidates, m, id, at);
        if (candidates == 0) return found;
        if constexpr (wanted == Wanted::any) {
            end(candidates, id, at);
        } else {
            // Store the new hits and limits.
            better = mask_of(candidates);
            hn::BlendedStore(t, better, f, t_limit + at);
            hn::BlendedStore(hn::Load(f, m.u), better, f, u + at);
            hn::BlendedStore(hn::Load(f, m.v), better, f, v + at);
            hn::BlendedStore(hn::BitCast(f, hn::Set(u32, id)), better, f,
                             reinterpret_cast<float*>(element) + at);
            hn::BlendedStore(s_limit_of(f, t, hn::Load(f, z_length + at)), better, f, s_limit + at);
        }
        return true;
    }

    /// Any hit: gives rays from `at` on (a bit each) their answer.
    HWY_INLINE void end(unsigned rays, std::uint32_t id, int at) {
        const M hit = mask_of(rays);
        hn::BlendedStore(hn::BitCast(f, hn::Set(u32, id)), hit, f, reinterpret_cast<float*>(element) + at);
        hn::BlendedStore(hn::Set(f, -1.0f), hit, f, s_limit + at);
    }

    /// The candidates that the filter of the call keeps.
    [[gnu::cold]] HWY_NOINLINE unsigned kept_of(const WideScene& scene, unsigned candidates,
                                                const Meetings& m, std::uint32_t id, int at) const {
        unsigned keeps = 0;
        for (unsigned left = candidates; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            if (kept_alone(scene, m, i, at + i, id)) keeps |= 1u << i;
        }
        return keeps;
    }
    [[gnu::cold]] HWY_NOINLINE bool kept_alone(const WideScene& scene, const Meetings& m, int i, int ray,
                                               std::uint32_t id) const {
        return kept(scene, number(ray), m.t[i], m.u[i], m.v[i], id);
    }

    std::int32_t pair_[8 * few + 16];  // 16 more, since pairs are written as whole vectors
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
