// Rays that go the same way, 64 at a time: which children any of them may enter is asked once for all, by
// intervals of what their slabs are made of (Boulos, Wald, Benthin, RT 2008; Reshetov, Soupikov, Hurley,
// SIGGRAPH 2005), and a child is entered with those rays that do enter it. (Read once for each instruction
// set.)

template <int W, Wanted wanted>
class Packet {
public:
    static constexpr int size = 64;

    explicit Packet(const WideScene& scene) : scene_(scene) {}

    /// Reads `size` rays, and tells in which ways they go: a bit for each that any of them goes. A way is a
    /// longest axis, and along each axis up or down. 0 if a ray is not usable.
    HWY_INLINE std::uint32_t look(const RayArray<float, 3>& rays, std::size_t from) {
        from_ = from;
        M usable = hn::Eq(hn::Zero(f), hn::Zero(f));
        auto ways = hn::Zero(u32);
        for (int p = 0; p < parts; ++p) {
            read_rows(rays, from + static_cast<std::size_t>(p * lanes), numbers_[p]);
            const auto way = way_of(p, usable);
            hn::Store(way, u32, way_ + p * lanes);
            ways = hn::Or(ways, hn::Shl(hn::Set(u32, 1), way));
        }
        if (!hn::AllTrue(f, usable)) return 0;
        alignas(64) std::uint32_t each[lanes];
        hn::Store(ways, u32, each);
        return std::accumulate(each, each + lanes, 0u, std::bit_or());
    }
    /// Answers those that go this way.
    template <class Answer>
    HWY_INLINE void answer(std::uint32_t way, Answer* answers) {
        take(way);
        trace();
        for (int i = 0; i < size; ++i) {
            if (way_[i] != way) continue;
            if constexpr (wanted == Wanted::any)
                answers[i] = element_[i] != Hit<float>::none;
            else
                answers[i] = hit_of(scene_, t_limit_[i], u_[i], v_[i], element_[i]);
        }
    }
    /// Leaves entered so far, and rays that entered them.
    std::size_t leaves() const { return leaves_; }
    std::size_t rays_in_leaves() const { return rays_in_leaves_; }

private:
    using F = Floats<16>;
    using V = hn::Vec<F>;
    using M = hn::Mask<F>;
    static constexpr F f{};
    static constexpr hn::RebindToUnsigned<F> u32{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(f)), parts = size / lanes;
    using Stack = WalkStack<W>;

    static HWY_INLINE V direction(V given) {
        return hn::IfThenZeroElse(hn::Lt(hn::Abs(given), hn::Set(f, std::numeric_limits<float>::min())),
                                  given);
    }
    static HWY_INLINE V t_min_of(V given) { return hn::IfThenZeroElse(hn::Lt(given, hn::Zero(f)), given); }

    HWY_INLINE hn::Vec<decltype(u32)> way_of(int p, M& usable) const {
        const auto number = [&](int w) { return hn::Load(f, numbers_[p][w]); };
        const auto all = [&](float x) { return hn::Set(f, x); };
        V d[3], length[3];
        for (int k = 0; k < 3; ++k) {
            d[k] = direction(number(3 + k));
            length[k] = hn::Abs(d[k]);
            usable = hn::And(usable, hn::And(hn::Le(length[k], all(std::numeric_limits<float>::max())),
                                             hn::Le(hn::Abs(number(k)), all(largest_coordinate<float>))));
        }
        const V longest = hn::Max(length[0], hn::Max(length[1], length[2]));
        usable =
            hn::And(usable, hn::And(hn::Gt(longest, hn::Zero(f)), hn::Le(t_min_of(number(6)), number(7))));
        // The first of the longest, as max_axis has it.
        const auto is = [&](int k) { return hn::RebindMask(u32, hn::Eq(length[k], longest)); };
        auto way =
            hn::IfThenElse(is(0), hn::Set(u32, 0), hn::IfThenElse(is(1), hn::Set(u32, 8), hn::Set(u32, 16)));
        for (int k = 0; k < 3; ++k) {
            const auto down = hn::ShiftRight<31>(hn::BitCast(u32, d[k]));
            way = hn::Or(way, k == 0 ? down : k == 1 ? hn::ShiftLeft<1>(down) : hn::ShiftLeft<2>(down));
        }
        return way;
    }
    HWY_INLINE void take(std::uint32_t way) {
        z_axis_ = static_cast<int>(way / 8);
        for (int k = 0; k < 3; ++k) {
            axis_[k] = (z_axis_ + 1 + k) % 3;
            down_[k] = (way >> k & 1) != 0;
            near_row_[k] = static_cast<std::size_t>(2 * k + down_[k]) * 4 * W;
        }
        const auto leader = static_cast<int>(std::find(way_, way_ + size, way) - way_);
        for (int p = 0; p < parts; ++p) prepare_rays(way, leader, p);
        take_intervals();
    }

    /// As `prepare` (rays-inl.h), rays in lanes. Those that go another way enter nothing, and have the
    /// leader's numbers, so that they widen no interval.
    HWY_INLINE void prepare_rays(std::uint32_t way, int leader, int p) {
        const int at = p * lanes;
        const M goes = hn::RebindMask(f, hn::Eq(hn::Load(u32, way_ + at), hn::Set(u32, way)));
        const auto number = [&](int w) {
            return hn::IfThenElse(goes, hn::Load(f, numbers_[p][w]),
                                  hn::Set(f, numbers_[leader / lanes][w][leader % lanes]));
        };
        const auto all = [&](float x) { return hn::Set(f, x); };
        const V zero = hn::Zero(f);
        V o[3], d[3], length[3], far_off = zero, reach = zero;
        for (int k = 0; k < 3; ++k) {
            o[k] = number(k), d[k] = direction(number(3 + k));
            length[k] = hn::Abs(d[k]);
            far_off = hn::Max(far_off, hn::Abs(o[k]));
            reach = hn::Max(reach, hn::Max(hn::Abs(hn::Sub(all(scene_.tree.bounds.low[k]), o[k])),
                                           hn::Abs(hn::Sub(all(scene_.tree.bounds.high[k]), o[k]))));
        }
        const V longest = length[z_axis_], z = d[z_axis_], t_min = t_min_of(number(6)), t_max = number(7);

        const V room = hn::Mul(all(underflow), hn::Add(all(1.0f), longest));
        const V slack = hn::MulAdd(all(16 * unit_roundoff<float>), reach,
                                   hn::MulAdd(all(4 * unit_roundoff<float>), far_off, room));
        for (int k = 0; k < 3; ++k) {
            const V inverse = hn::CopySign(hn::Min(hn::Div(longest, length[k]), all(0x1p60f)), d[k]);
            const V outward = hn::CopySign(slack, d[k]);
            const V enter = hn::Add(o[k], outward), leave = hn::Sub(o[k], outward);
            hn::Store(inverse, f, inverse_[k] + at);
            hn::Store(enter, f, enter_[k] + at);
            hn::Store(leave, f, leave_[k] + at);
            hn::Store(hn::Mul(enter, inverse), f, enter_at_[k] + at);
            hn::Store(hn::Mul(leave, inverse), f, leave_at_[k] + at);
            hn::Store(o[axis_[k]], f, origin_[k] + at);
        }
        for (int k = 0; k < 2; ++k) hn::Store(hn::Div(d[axis_[k]], z), f, shear_[k] + at);
        hn::Store(z, f, z_ + at);
        const V s_low = hn::Sub(hn::Mul(hn::Mul(t_min, longest), all(1 - wider)), room);
        hn::Store(s_low, f, s_low_ + at);
        hn::Store(hn::Max(s_low, zero), f, s_min_ + at);
        hn::Store(hn::IfThenElse(goes, limit_of(t_max, longest), all(-1.0f)), f, s_limit_ + at);
        hn::Store(longest, f, z_length_ + at);
        hn::Store(t_min, f, t_min_ + at);
        hn::Store(t_max, f, t_limit_ + at);
        hn::Store(hn::Set(u32, Hit<float>::none), u32, element_ + at);
    }
    static HWY_INLINE V limit_of(V t, V z_length) {
        return hn::MulAdd(hn::Mul(t, z_length), hn::Set(f, 1 + wider),
                          hn::Mul(hn::Set(f, underflow), hn::Add(hn::Set(f, 1.0f), z_length)));
    }

    struct Range {
        float low, high;
    };
    static HWY_INLINE Range range_of(const float* values) {
        V low = hn::Load(f, values), high = low;
        for (int at = lanes; at < size; at += lanes) {
            const V x = hn::Load(f, values + at);
            low = hn::Min(low, x), high = hn::Max(high, x);
        }
        return {hn::GetLane(hn::MinOfLanes(f, low)), hn::GetLane(hn::MaxOfLanes(f, high))};
    }
    HWY_INLINE void take_intervals() {
        common_origin_ = true;
        for (int k = 0; k < 3; ++k) {
            const Range enter = range_of(enter_[k]), leave = range_of(leave_[k]),
                        origin = range_of(origin_[k]);
            inverses_[k] = range_of(inverse_[k]);
            enters_[k] = down_[k] ? enter.low : enter.high;
            leaves_at_[k] = down_[k] ? leave.high : leave.low;
            common_origin_ &= origin.low == origin.high;
        }
        for (int k = 0; k < 2; ++k) shears_[k] = range_of(shear_[k]);
        s_first_ = range_of(s_min_).low;
        s_last_ = range_of(s_limit_).high;
    }

    /// Where along an axis the first ray meets a box's near plane, and the last one its far plane.
    template <class B>
    HWY_INLINE hn::Vec<B> earliest(B b, int k, hn::Vec<B> planes) const {
        const auto ahead = hn::Sub(planes, hn::Set(b, enters_[k]));
        return hn::Min(hn::Mul(ahead, hn::Set(b, inverses_[k].low)),
                       hn::Mul(ahead, hn::Set(b, inverses_[k].high)));
    }
    template <class B>
    HWY_INLINE hn::Vec<B> latest(B b, int k, hn::Vec<B> planes) const {
        const auto behind = hn::Sub(planes, hn::Set(b, leaves_at_[k]));
        return hn::Max(hn::Mul(behind, hn::Set(b, inverses_[k].low)),
                       hn::Mul(behind, hn::Set(b, inverses_[k].high)));
    }
    /// The children that some ray may enter, and where the first of them does at the earliest.
    HWY_INLINE Boxes<W> boxes_of(const std::byte* node) const {
        using B = Floats<W>;
        constexpr B b;
        Boxes<W> boxes;
        for (int p = 0; p < Boxes<W>::parts; ++p) {
            hn::Vec<B> near_s[3], far_s[3];
            for (int k = 0; k < 3; ++k) {
                near_s[k] = earliest(b, k, Boxes<W>::row(node, near_row_[k], p));
                far_s[k] = latest(b, k, Boxes<W>::row(node, near_row_[k] ^ (4 * W), p));
            }
            boxes.entry[p] = hn::Max(hn::Max(near_s[0], near_s[1]), hn::Max(near_s[2], hn::Set(b, s_first_)));
            boxes.entered[p] = hn::Le(
                boxes.entry[p], hn::Min(hn::Min(far_s[0], far_s[1]), hn::Min(far_s[2], hn::Set(b, s_last_))));
        }
        return boxes;
    }
    /// Which rays from `at` on enter child i of a node.
    HWY_INLINE M enters(const std::byte* node, int i, int at) const {
        V near_s[3], far_s[3];
        for (int k = 0; k < 3; ++k) {
            const float* const near_row = reinterpret_cast<const float*>(node + near_row_[k]);
            const float* const far_row = reinterpret_cast<const float*>(node + (near_row_[k] ^ (4 * W)));
            const V inverse = hn::Load(f, inverse_[k] + at);
            near_s[k] = hn::MulSub(hn::Set(f, near_row[i]), inverse, hn::Load(f, enter_at_[k] + at));
            far_s[k] = hn::MulSub(hn::Set(f, far_row[i]), inverse, hn::Load(f, leave_at_[k] + at));
        }
        return hn::Le(hn::Max(hn::Max(near_s[0], near_s[1]), hn::Max(near_s[2], hn::Load(f, s_min_ + at))),
                      hn::Min(hn::Min(far_s[0], far_s[1]), hn::Min(far_s[2], hn::Load(f, s_limit_ + at))));
    }

    /// Children stand on the stack by their node and place in it, so that their boxes are found.
    HWY_INLINE void open(Stack& stack, std::uint32_t number) {
        const std::byte* const node = scene_.tree.nodes.at(number);
        alignas(64) std::uint32_t places[W];
        for (std::uint32_t i = 0; i < W; ++i) places[i] = number * W + i;
        stack.push(boxes_of(node), places);
    }
    HWY_INLINE void trace() {
        constexpr int room = Stack::room(bvh_max_depth + 1);
        std::int32_t entries[room];
        std::uint32_t words[room];
        Stack stack(entries, words, 0, 0);
        stack.clear();
        open(stack, 0);
        for (std::uint32_t place = stack.pop(); place != Stack::end; place = stack.pop()) {
            const std::byte* const node = scene_.tree.nodes.at(place / W);
            const int child = static_cast<int>(place % W);
            const std::uint32_t word = children_of<W>(node)[child];
            if ((word & WideChild::leaf_bit) == 0) {
                __builtin_prefetch(scene_.tree.nodes.at(word));
                bool any = false;
                for (int p = 0; p < parts && !any; ++p)
                    any = !hn::AllFalse(f, enters(node, child, p * lanes));
                if (any) open(stack, word);
                continue;
            }
            std::uint64_t active = 0;
            for (int p = 0; p < parts; ++p)
                active |= std::uint64_t(bits_of(f, enters(node, child, p * lanes))) << (p * lanes);
            if (active == 0) continue;
            ++leaves_;
            rays_in_leaves_ += static_cast<std::size_t>(std::popcount(active));
            if (!test_leaf(scene_.blocks[word & ~WideChild::leaf_bit], active)) continue;
            s_last_ = range_of(s_limit_).high;
            if (s_last_ < 0) return;  // any hit: all have theirs
            stack.sweep(s_last_);
        }
    }

    /// True if some ray was hit. All rays are held against all triangles first, without a branch.
    HWY_INLINE bool test_leaf(const TriangleBlock<float>& block, std::uint64_t active) {
        alignas(64) float corner[3][3][8];  // by the rays' axes, without the origin where they share it
        const unsigned triangles = seen_of(block, corner);
        std::uint64_t candidates[8];
        for (unsigned left = triangles; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            std::uint64_t rays = 0;
            for (int at = 0; at < size; at += lanes) {
                const M kept = corners_of(corner, i, at)
                                   .may_meet(f, hn::Load(f, z_ + at), hn::Load(f, s_low_ + at),
                                             hn::Load(f, s_limit_ + at));
                rays |= std::uint64_t(bits_of(f, kept)) << at;
            }
            candidates[i] = rays & active;
        }
        bool found = false;
        for (unsigned left = triangles; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            for (std::uint64_t rays = candidates[i]; rays != 0;) {
                const int at = std::countr_zero(rays) / lanes * lanes;
                constexpr std::uint64_t every = (std::uint64_t(1) << lanes) - 1;
                found |= meet(corners_of(corner, i, at), block.id[i], at,
                              static_cast<unsigned>(rays >> at & every));
                rays &= ~(every << at);
            }
        }
        return found;
    }
    /// The corners by the rays' axes, and which triangles some ray may meet.
    HWY_INLINE unsigned seen_of(const TriangleBlock<float>& block, float (&corner)[3][3][8]) const {
        using E = Floats<8>;
        constexpr E e;
        unsigned seen = 0;
        for (int at = 0; at < 8; at += static_cast<int>(hn::MaxLanes(e))) {
            hn::Vec<E> c[3][3];
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) {
                    c[k][i] = hn::Load(e, block.corner[axis_[k]][i] + at);
                    if (common_origin_) c[k][i] = hn::Sub(c[k][i], hn::Set(e, origin_[k][0]));
                    hn::Store(c[k][i], e, corner[k][i] + at);
                }
            const auto filled = hn::Eq(c[0][0], c[0][0]);  // not NaN
            seen |= bits_of(e, hn::And(filled, common_origin_ ? around_origin(e, c) : entered(e, c))) << at;
        }
        return seen;
    }
    /// Not those all whose corners lie, for every ray, on the same side of it. What is asked is what the test
    /// of a ray computes, for the rays of least and of most shear, between which rounding keeps all others.
    template <class E>
    HWY_INLINE hn::Mask<E> around_origin(E e, const hn::Vec<E> (&c)[3][3]) const {
        auto around = hn::Eq(hn::Zero(e), hn::Zero(e));
        for (int k = 0; k < 2; ++k) {
            auto least = hn::Set(e, std::numeric_limits<float>::infinity()), most = hn::Neg(least);
            for (int i = 0; i < 3; ++i)
                for (const float shear : {shears_[k].low, shears_[k].high}) {
                    const auto x = hn::Sub(c[k][i], hn::Mul(hn::Set(e, shear), c[2][i]));
                    least = hn::Min(least, x), most = hn::Max(most, x);
                }
            around = hn::And(around, hn::And(hn::Le(least, hn::Zero(e)), hn::Ge(most, hn::Zero(e))));
        }
        return around;
    }
    /// Those whose boxes some ray may enter.
    template <class E>
    HWY_INLINE hn::Mask<E> entered(E e, const hn::Vec<E> (&c)[3][3]) const {
        auto entry = hn::Set(e, s_first_), exit = hn::Set(e, s_last_);
        for (int k = 0; k < 3; ++k) {
            const auto low = hn::Min(c[k][0], hn::Min(c[k][1], c[k][2]));
            const auto high = hn::Max(c[k][0], hn::Max(c[k][1], c[k][2]));
            const bool down = down_[axis_[k]];
            entry = hn::Max(entry, earliest(e, axis_[k], down ? high : low));
            exit = hn::Min(exit, latest(e, axis_[k], down ? low : high));
        }
        return hn::Le(entry, exit);
    }
    HWY_INLINE Corners<F> corners_of(const float (&corner)[3][3][8], int i, int at) const {
        const auto from_origin = [&](int k, int c) {
            const V x = hn::Set(f, corner[k][c][i]);
            return common_origin_ ? x : hn::Sub(x, hn::Load(f, origin_[k] + at));
        };
        return Corners<F>(from_origin, hn::Load(f, shear_[0] + at), hn::Load(f, shear_[1] + at));
    }
    /// Of the candidates among the rays from `at` on, those that are hit nearer than before (or as near, and
    /// the triangle has a lower number) have this triangle as their hit.
    HWY_INLINE bool meet(const Corners<F>& corners, std::uint32_t id, int at, unsigned candidates) {
        Meetings m;
        const auto z = [&](auto d, int from) {
            return hn::PromoteTo(d, hn::Load(hn::Rebind<float, decltype(d)>(), z_ + at + from));
        };
        candidates = meet_exactly_among(f, corners, candidates, z, m);
        const V t = hn::Load(f, m.t), limit = hn::Load(f, t_limit_ + at);
        const M lower = hn::RebindMask(f, hn::Lt(hn::Set(u32, id), hn::Load(u32, element_ + at)));
        M better = hn::And(hn::Ge(t, hn::Load(f, t_min_ + at)),
                           hn::Le(t, hn::Set(f, std::numeric_limits<float>::max())));
        better = hn::And(better, hn::Or(hn::Lt(t, limit), hn::And(hn::Eq(t, limit), lower)));
        candidates &= bits_of(f, better);
        if (scene_.filter.keeps != nullptr) [[unlikely]]
            candidates = kept_of(candidates, m, id, at);
        if (candidates == 0) return false;
        const std::uint64_t bits = candidates;
        better = hn::LoadMaskBits(f, reinterpret_cast<const std::uint8_t*>(&bits));
        hn::BlendedStore(t, better, f, t_limit_ + at);
        hn::BlendedStore(hn::Load(f, m.u), better, f, u_ + at);
        hn::BlendedStore(hn::Load(f, m.v), better, f, v_ + at);
        hn::BlendedStore(hn::BitCast(f, hn::Set(u32, id)), better, f,
                         reinterpret_cast<float*>(element_) + at);
        const V s_limit =
            wanted == Wanted::any ? hn::Set(f, -1.0f) : limit_of(t, hn::Load(f, z_length_ + at));
        hn::BlendedStore(s_limit, better, f, s_limit_ + at);
        return true;
    }

    /// Those that the filter keeps.
    [[gnu::cold]] HWY_NOINLINE unsigned kept_of(unsigned candidates, const Meetings& m, std::uint32_t id,
                                                int at) const {
        unsigned keeps = 0;
        for (unsigned left = candidates; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            const std::size_t number = from_ + static_cast<std::size_t>(at + i);
            if (kept(scene_, number, m.t[i], m.u[i], m.v[i], id)) keeps |= 1u << i;
        }
        return keeps;
    }

    const WideScene& scene_;
    std::size_t from_ = 0;  // the number of the first ray
    std::size_t leaves_ = 0, rays_in_leaves_ = 0;
    // Of the rays, as they were given, and which way they go.
    alignas(64) float numbers_[parts][8][lanes];
    alignas(64) std::uint32_t way_[size];
    // Of those that are answered: see WideRay.
    alignas(64) float inverse_[3][size], enter_[3][size], leave_[3][size], enter_at_[3][size],
        leave_at_[3][size];
    alignas(64) float origin_[3][size], shear_[2][size], z_[size], z_length_[size];
    alignas(64) float s_low_[size], s_min_[size], s_limit_[size], t_min_[size], t_limit_[size], u_[size],
        v_[size];
    alignas(64) std::uint32_t element_[size];
    // Of all together.
    int z_axis_, axis_[3];
    bool down_[3], common_origin_;
    std::size_t near_row_[3];
    Range inverses_[3], shears_[2];
    float enters_[3], leaves_at_[3];  // the origins, e outward, that bring boxes nearest and farthest
    float s_first_, s_last_;
};
