/// The 64 rays of a packet, which go the same way: the numbers of each ray, and intervals that contain those
/// of all rays.
#if defined(HEDGEROW_ENGINE_PACKET_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_PACKET_RAYS_INL_H
#undef HEDGEROW_ENGINE_PACKET_RAYS_INL_H
#else
#define HEDGEROW_ENGINE_PACKET_RAYS_INL_H
#endif

#include <algorithm>
#include <functional>
#include <numeric>

#include <hwy/highway.h>

#include "picture-inl.h"
#include "rays-inl.h"
#include "reader-inl.h"
#include "tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

struct PacketRays {
    static constexpr int size = block_size;
    using F = Floats<16>;
    using V = hn::Vec<F>;
    using M = hn::Mask<F>;
    static constexpr F f{};
    static constexpr hn::RebindToUnsigned<F> u32{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(f)), parts = size / lanes;

    // The rays as given, and the way that each goes.
    std::size_t first, row;
    alignas(64) float numbers[parts][8][lanes];
    alignas(64) std::uint32_t ways[size];
    // The rays that are answered at the moment. WideRay explains the names.
    alignas(64) float inverse[3][size], enter[3][size], leave[3][size], enter_at[3][size], leave_at[3][size];
    alignas(64) float origin[3][size], shear[2][size], z[size], z_length[size];
    alignas(64) float s_low[size], s_min[size], s_limit[size], t_min[size], t_limit[size];
    // Intervals over all rays.
    struct Range {
        float low, high;
    };
    int z_axis, axis[3];
    bool down[3], common_origin;
    Range inverses[3], shears[2];
    float enters[3], leaves[3];  // the origins (± e) from which boxes are nearest and farthest
    float s_first, s_last;

    /// Reads 64 rays: 8 rows of 8, from `from` on, with `apart` rays from one row to the next. Returns the
    /// ways that they go, a bit each, or 0 if a ray is not usable. A way is a longest axis, and up or down
    /// along each axis.
    HWY_INLINE std::uint32_t look(const RayArray<float, 3>& rays, std::size_t from, std::size_t apart) {
        first = from, row = apart;
        return look(
            [&](int p) { read_rows(f, rays, number(p * lanes), number(p * lanes + lanes / 2), numbers[p]); });
    }
    /// The same of rays whose numbers read(p) writes to numbers[p].
    template <class Read>
    HWY_INLINE std::uint32_t look(Read read) {
        M usable = hn::Eq(hn::Zero(f), hn::Zero(f));
        auto all = hn::Zero(u32);
        for (int p = 0; p < parts; ++p) {
            read(p);
            const auto way = way_of(p, usable);
            hn::Store(way, u32, ways + p * lanes);
            all = hn::Or(all, hn::Shl(hn::Set(u32, 1), way));
        }
        if (!hn::AllTrue(f, usable)) return 0;
        alignas(64) std::uint32_t each[lanes];
        hn::Store(all, u32, each);
        return std::accumulate(each, each + lanes, 0u, std::bit_or());
    }
    /// The rays of a vector, a bit each, as a mask.
    static HWY_INLINE M mask_of(unsigned rays) {
        const std::uint64_t bits = rays;
        return hn::LoadMaskBits(f, reinterpret_cast<const std::uint8_t*>(&bits));
    }
    /// The number of ray i in the batch.
    HWY_INLINE std::size_t number(int i) const {
        const auto place = static_cast<std::size_t>(i);
        return first + place / block_side * row + place % block_side;
    }
    /// Prepares the rays that go this way for boxes and triangles.
    HWY_INLINE void prepare(std::uint32_t way, const Box<float, 3>& scene) {
        const int leader = take_way(way);
        for (int p = 0; p < parts; ++p) {
            const Given given(*this, way, leader, p);
            prepare_slabs(given, p, scene);
            prepare_tests(given, p);
        }
        take_intervals();
    }
    /// Prepares the rays that go this way for triangles alone (`test_each`). `from_one_origin` says whether
    /// they all start there.
    HWY_INLINE void prepare_for_triangles(std::uint32_t way, bool from_one_origin) {
        const int leader = take_way(way);
        for (int p = 0; p < parts; ++p) {
            const Given given(*this, way, leader, p);
            prepare_tests(given, p);
        }
        common_origin = from_one_origin;
        take_shears();
        take_last();
    }
    /// Computes s_last anew. To be called when limits have changed.
    HWY_INLINE void take_last() { s_last = range_of(s_limit).high; }

    /// Along an axis, by the intervals: the s at which the first ray meets a box's near plane, and the s at
    /// which the last ray meets its far plane.
    template <class B>
    HWY_INLINE hn::Vec<B> earliest(B b, int k, hn::Vec<B> planes) const {
        const auto ahead = hn::Sub(planes, hn::Set(b, enters[k]));
        return hn::Min(hn::Mul(ahead, hn::Set(b, inverses[k].low)),
                       hn::Mul(ahead, hn::Set(b, inverses[k].high)));
    }
    template <class B>
    HWY_INLINE hn::Vec<B> latest(B b, int k, hn::Vec<B> planes) const {
        const auto behind = hn::Sub(planes, hn::Set(b, leaves[k]));
        return hn::Max(hn::Mul(behind, hn::Set(b, inverses[k].low)),
                       hn::Mul(behind, hn::Set(b, inverses[k].high)));
    }

private:
    static HWY_INLINE V t_min_of(V given) { return hn::IfThenZeroElse(hn::Lt(given, hn::Zero(f)), given); }

    /// The way of each ray: 8 times the longest axis, and bit k where it goes down along axis k. Clears
    /// `usable` where a ray is not usable.
    HWY_INLINE hn::Vec<decltype(u32)> way_of(int p, M& usable) const {
        const auto given = [&](int w) { return hn::Load(f, numbers[p][w]); };
        const auto all = [&](float x) { return hn::Set(f, x); };
        // Usable: finite directions, origins within bounds, a direction that is not 0 and an interval that
        // is not empty.
        V d[3], length[3];
        for (int k = 0; k < 3; ++k) {
            d[k] = usable_direction(f, given(3 + k));
            length[k] = hn::Abs(d[k]);
            usable = hn::And(usable, hn::And(hn::Le(length[k], all(std::numeric_limits<float>::max())),
                                             hn::Le(hn::Abs(given(k)), all(largest_coordinate<float>))));
        }
        const V longest = hn::Max(length[0], hn::Max(length[1], length[2]));
        usable = hn::And(usable, hn::And(hn::Gt(longest, hn::Zero(f)), hn::Le(t_min_of(given(6)), given(7))));
        // The first of the longest, as in max_axis.
        const auto is = [&](int k) { return hn::RebindMask(u32, hn::Eq(length[k], longest)); };
        auto way =
            hn::IfThenElse(is(0), hn::Set(u32, 0), hn::IfThenElse(is(1), hn::Set(u32, 8), hn::Set(u32, 16)));
        for (int k = 0; k < 3; ++k) {
            const auto negative = hn::ShiftRight<31>(hn::BitCast(u32, d[k]));
            way = hn::Or(way, k == 0   ? negative
                              : k == 1 ? hn::ShiftLeft<1>(negative)
                                       : hn::ShiftLeft<2>(negative));
        }
        return way;
    }

    /// Notes the axes of a way. Returns the first ray that goes it.
    HWY_INLINE int take_way(std::uint32_t way) {
        z_axis = static_cast<int>(way / 8);
        for (int k = 0; k < 3; ++k) {
            axis[k] = (z_axis + 1 + k) % 3;
            down[k] = (way >> k & 1) != 0;
        }
        return static_cast<int>(std::find(ways, ways + size, way) - ways);
    }
    /// A vector of rays as given. Rays that go another way get the leader's numbers, so that they widen no
    /// interval.
    struct Given {
        M goes;
        V o[3], d[3], length[3], longest, from, to;

        HWY_INLINE Given(const PacketRays& rays, std::uint32_t way, int leader, int p)
            : goes(hn::RebindMask(f, hn::Eq(hn::Load(u32, rays.ways + p * lanes), hn::Set(u32, way)))) {
            const auto given = [&](int w) __attribute__((always_inline)) {
                return hn::IfThenElse(goes, hn::Load(f, rays.numbers[p][w]),
                                      hn::Set(f, rays.numbers[leader / lanes][w][leader % lanes]));
            };
            for (int k = 0; k < 3; ++k) {
                o[k] = given(k), d[k] = usable_direction(f, given(3 + k));
                length[k] = hn::Abs(d[k]);
            }
            longest = length[rays.z_axis];
            from = t_min_of(given(6)), to = given(7);
        }
    };
    static HWY_INLINE V underflow_of(const Given& given) {
        return hn::Mul(hn::Set(f, underflow), hn::Add(hn::Set(f, 1.0f), given.longest));
    }

    // Together these do what `prepare` (rays-inl.h) does, with rays in lanes.

    /// The error e, and the slabs widened by it.
    HWY_INLINE void prepare_slabs(const Given& given, int p, const Box<float, 3>& scene) {
        const int at = p * lanes;
        V far_off = hn::Zero(f), reach = far_off;
        for (int k = 0; k < 3; ++k) {
            far_off = hn::Max(far_off, hn::Abs(given.o[k]));
            reach = hn::Max(reach, hn::Max(hn::Abs(hn::Sub(hn::Set(f, scene.low[k]), given.o[k])),
                                           hn::Abs(hn::Sub(hn::Set(f, scene.high[k]), given.o[k]))));
        }
        const V slack = slack_of(f, reach, far_off, underflow_of(given));
        for (int k = 0; k < 3; ++k) {
            const V i = inverse_of(f, given.longest, given.length[k], given.d[k]);
            const V outward = hn::CopySign(slack, given.d[k]);
            const V entering = hn::Add(given.o[k], outward), leaving = hn::Sub(given.o[k], outward);
            hn::Store(i, f, inverse[k] + at);
            hn::Store(entering, f, enter[k] + at);
            hn::Store(leaving, f, leave[k] + at);
            hn::Store(hn::Mul(entering, i), f, enter_at[k] + at);
            hn::Store(hn::Mul(leaving, i), f, leave_at[k] + at);
        }
    }
    /// Shears for the test of triangles, and the interval of s. Rays that go another way get a negative
    /// limit, so that they hit nothing.
    HWY_INLINE void prepare_tests(const Given& given, int p) {
        const int at = p * lanes;
        const V along = given.d[z_axis];
        for (int k = 0; k < 3; ++k) hn::Store(given.o[axis[k]], f, origin[k] + at);
        for (int k = 0; k < 2; ++k) hn::Store(hn::Div(given.d[axis[k]], along), f, shear[k] + at);
        hn::Store(along, f, z + at);
        const V low =
            hn::Sub(hn::Mul(hn::Mul(given.from, given.longest), hn::Set(f, 1 - wider)), underflow_of(given));
        hn::Store(low, f, s_low + at);
        hn::Store(hn::Max(low, hn::Zero(f)), f, s_min + at);
        hn::Store(hn::IfThenElse(given.goes, s_limit_of(f, given.to, given.longest), hn::Set(f, -1.0f)), f,
                  s_limit + at);
        hn::Store(given.longest, f, z_length + at);
        hn::Store(given.from, f, t_min + at);
        hn::Store(given.to, f, t_limit + at);
    }

    static HWY_INLINE Range range_of(const float* values) {
        V low = hn::Load(f, values), high = low;
        for (int at = lanes; at < size; at += lanes) {
            const V x = hn::Load(f, values + at);
            low = hn::Min(low, x), high = hn::Max(high, x);
        }
        return {hn::GetLane(hn::MinOfLanes(f, low)), hn::GetLane(hn::MaxOfLanes(f, high))};
    }
    HWY_INLINE void take_intervals() {
        common_origin = true;
        for (int k = 0; k < 3; ++k) {
            const Range entering = range_of(enter[k]), leaving = range_of(leave[k]), o = range_of(origin[k]);
            inverses[k] = range_of(inverse[k]);
            enters[k] = down[k] ? entering.low : entering.high;
            leaves[k] = down[k] ? leaving.high : leaving.low;
            common_origin &= o.low == o.high;
        }
        take_shears();
        s_first = range_of(s_min).low;
        take_last();
    }
    HWY_INLINE void take_shears() {
        for (int k = 0; k < 2; ++k) shears[k] = range_of(shear[k]);
    }
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
