// Rays as the kernels carry them. (No include guard: this file is read once for each instruction set, by
// kernels.cpp.)

// Boxes are entered by distances along the ray's longest axis, s = t·|d_z| (x, y, z here: the ray's own axes,
// z the longest): nothing is infinite then, since what is all but parallel to a plane is taken as 2^-60 out
// of parallel, far less than its error. What is conservative is as in RayProbe, whose docstring has the bound
// e; here a plane's s is plane · inverse − (o ± e) · inverse, which errs by 3u·M + 2u·|o| at most, fused or
// not.
struct alignas(64) WideRay {
    float inverse[4], enter_at[4], leave_at[4];  // by the scene's axes, as the next; the fourth is of no use
    std::uint32_t near_row[4];                   // where the near planes of a node begin, in bytes
    float origin[4], shear[4];                   // by the ray's axes; of the shear x and y
    float s_min, s_limit;                        // the interval to search, a little wider than t's
    float z, z_length;                           // of the direction; |z|
    float s_low;                                 // s_min with room for what t may underflow by
    float t_min, t_limit;
    // The nearest hit so far, of t_limit; element is none before there is one.
    float u, v;
    std::uint32_t element;
    std::uint32_t row[3];  // where the corners' coordinates begin in a block, in floats, by the ray's axes
    bool usable;
};

// How much an interval of t is widened for s: two roundings, and underflow.
inline constexpr float wider = 0x1p-22f, underflow = 0x1p-126f;

HWY_INLINE float s_limit_of(float t, float z_length) {
    return t * z_length * (1 + wider) + underflow * (1 + z_length);
}
template <class F>
HWY_INLINE hn::Vec<F> s_limit_of(F f, hn::Vec<F> t, hn::Vec<F> z_length) {
    return hn::MulAdd(hn::Mul(t, z_length), hn::Set(f, 1 + wider),
                      hn::Mul(hn::Set(f, underflow), hn::Add(hn::Set(f, 1.0f), z_length)));
}

// By which of the scene's axes is the longest: the others in their turn.
alignas(16) inline constexpr std::int32_t turned[3][4] = {{1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};

// For nodes of W children. The arithmetic of what t, u and v come of is that of WatertightRay, axes in lanes.
// Of the origin and the direction the first three lanes count. `more` is added to e, as in RayProbe.
template <int W>
HWY_INLINE void prepare(hn::Vec<hn::FixedTag<float, 4>> origin, hn::Vec<hn::FixedTag<float, 4>> direction,
                        float asked_t_min, float t_max, const Box<float, 3>& scene, float more,
                        WideRay& ray) {
    constexpr hn::FixedTag<float, 4> f;
    constexpr hn::FixedTag<std::int32_t, 4> i32;
    constexpr hn::FixedTag<std::uint32_t, 4> u32;
    const auto all = [&](float x) { return hn::Set(f, x); };
    const auto axes = hn::FirstN(f, 3);
    static_assert(sizeof scene == 6 * sizeof(float));
    const float* const corners = reinterpret_cast<const float*>(&scene);
    const auto low = hn::LoadU(f, corners), high = hn::Shuffle0321(hn::LoadU(f, corners + 2));
    const auto o = hn::IfThenElseZero(axes, origin);
    const auto given = hn::IfThenElseZero(axes, direction);
    const auto d = hn::IfThenZeroElse(hn::Lt(hn::Abs(given), all(std::numeric_limits<float>::min())), given);
    const auto length = hn::Abs(d), distance = hn::Abs(o);
    const auto longest = hn::MaxOfLanes(f, length);
    const float z_length = hn::GetLane(longest);
    const float t_min = asked_t_min < 0 ? 0.0f : asked_t_min;
    ray.usable = hn::AllTrue(f, hn::And(hn::Le(length, all(std::numeric_limits<float>::max())),
                                        hn::Le(distance, all(largest_coordinate<float>)))) &&
                 z_length > 0 && t_min <= t_max;

    // e, as RayProbe has it; the subnormal steps are always added
    const auto reach = hn::MaxOfLanes(
        f, hn::IfThenElseZero(axes, hn::Max(hn::Abs(hn::Sub(low, o)), hn::Abs(hn::Sub(high, o)))));
    const auto far_off = hn::MaxOfLanes(f, distance);
    const float room = underflow * (1 + z_length);
    const auto by_origin = hn::MulAdd(all(4 * unit_roundoff<float>), far_off, all(more));
    const auto slack = hn::MulAdd(all(16 * unit_roundoff<float>), reach, hn::Add(by_origin, all(room)));
    const auto inverse = hn::CopySign(hn::Min(hn::Div(longest, length), all(0x1p60f)), d);
    const auto outward = hn::CopySign(slack, d);
    hn::Store(inverse, f, ray.inverse);
    hn::Store(hn::Mul(hn::Add(o, outward), inverse), f, ray.enter_at);
    hn::Store(hn::Mul(hn::Sub(o, outward), inverse), f, ray.leave_at);
    const auto down = hn::ShiftRight<31>(hn::BitCast(i32, d));  // −1 or 0
    const auto row = hn::Sub(hn::ShiftLeft<1>(hn::Iota(i32, 0)), down);
    hn::Store(hn::BitCast(u32, hn::ShiftLeft<std::countr_zero(4u * W)>(row)), u32, ray.near_row);

    // The first of the longest. Of NaN none is: then z, for a ray that is not usable.
    const auto is_longest = hn::Or(hn::Eq(length, longest), hn::Not(hn::FirstN(f, 2)));
    const std::int32_t* const turn = turned[hn::FindKnownFirstTrue(f, is_longest)];
    const auto order = hn::SetTableIndices(f, turn);
    const auto along = hn::TableLookupLanes(d, order);
    ray.z = hn::GetLane(hn::Shuffle1032(along));
    hn::Store(hn::TableLookupLanes(o, order), f, ray.origin);
    hn::Store(hn::Div(along, all(ray.z)), f, ray.shear);
    for (int k = 0; k < 3; ++k) ray.row[k] = 24 * static_cast<std::uint32_t>(turn[k]);

    ray.s_low = t_min * z_length * (1 - wider) - room;
    ray.s_min = ray.s_low > 0 ? ray.s_low : 0.0f;
    ray.s_limit = s_limit_of(t_max, z_length);
    ray.z_length = z_length;
    ray.t_min = t_min, ray.t_limit = t_max;
    ray.u = ray.v = 0;
    ray.element = Hit<float>::none;
}

// A ray as it lies in memory, the 8 numbers of a Ray, at any address.
template <int W>
HWY_INLINE void prepare(const std::byte* ray_at, const Box<float, 3>& scene, float more, WideRay& ray) {
    constexpr hn::FixedTag<float, 4> f;
    const float* const words = reinterpret_cast<const float*>(ray_at);
    float t_min, t_max;
    std::memcpy(&t_min, ray_at + 6 * sizeof(float), sizeof t_min);
    std::memcpy(&t_max, ray_at + 7 * sizeof(float), sizeof t_max);
    prepare<W>(hn::LoadU(f, words), hn::LoadU(f, words + 3), t_min, t_max, scene, more, ray);
}
