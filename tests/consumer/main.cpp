// Prints the bits of what the headers compute for fixed inputs, to be compared between builds of this
// program.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <type_traits>

#include <hedgerow/hedgerow.h>

using namespace hedgerow;

namespace {

template <class T>
auto bits(T x) {
    return std::bit_cast<std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>(x);
}
void print(float x) {
    std::printf("%08x ", bits(x));
}
void print(double x) {
    std::printf("%016llx ", static_cast<unsigned long long>(bits(x)));
}

// Prints differences of products of nearly equal size. They show whether the products were rounded first.
template <class T>
void products() {
    std::mt19937 random(1);
    const auto any = [&] { return T(1) + static_cast<T>(random()) / T(0x1p36); };
    for (int i = 0; i < 64; ++i) {
        T n[6];
        for (T& x : n) x = any();
        const Vec<T, 3> a(n[0], n[1], n[2]), b(n[3], n[4], n[5]);
        const Vec<T, 3> c = cross(a, b);
        for (int axis = 0; axis < 3; ++axis) print(c[axis]);
        print(dot(a, b));
        print(difference_of_products(a[0], b[1], a[1], b[0]));
        std::printf("\n");
    }
}

// FNV-1a over the bytes of values, lowest byte first, so that the hash does not depend on the byte order.
class Hash {
public:
    template <class U>
    requires std::is_integral_v<U>
    void add(U x) {
        for (std::size_t i = 0; i < sizeof(U); ++i) {
            value_ ^= static_cast<std::uint64_t>(x) >> (8 * i) & 0xFFu;
            value_ *= 0x100000001B3u;
        }
    }
    template <std::floating_point T>
    void add(T x) {
        add(bits(x));
    }
    unsigned long long value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325u;
};

template <class T>
class Numbers {
public:
    T within(T low, T high) { return low + product(high - low, static_cast<T>(random_() >> 8) * T(0x1p-24)); }
    Vec<T, 3> point(T low, T high) {
        const T x = within(low, high), y = within(low, high);
        return {x, y, within(low, high)};
    }
    std::size_t below(std::size_t n) { return random_() % n; }

private:
    std::mt19937 random_{2};
};

// A hilly sheet, whose triangles share their vertices, and loose triangles around it.
template <class T>
TriangleMesh<T> scene(Numbers<T>& numbers) {
    constexpr std::uint32_t side = 40;
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < side * side; ++i)
        mesh.vertices.emplace_back(static_cast<T>(i % side) / T(side - 1),
                                   static_cast<T>(i / side) / T(side - 1), numbers.within(T(0.4), T(0.6)));
    for (std::uint32_t y = 0; y + 1 < side; ++y)
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t at = y * side + x;
            mesh.triangles.push_back({at, at + 1, at + side});
            mesh.triangles.push_back({at + 1, at + side + 1, at + side});
        }
    for (int i = 0; i < 500; ++i) {
        const Vec<T, 3> near = numbers.point(T(0), T(1));
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(near + numbers.point(T(-0.05), T(0.05)));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

// Prints one line per structure: its name, the number of rays that hit, and a hash of all answers.
template <class T, class I>
void answers(const char* name, const I& index, const TriangleMesh<T>& mesh, Numbers<T> numbers) {
    Hash hash;
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec<T, 3> from = numbers.point(T(-1), T(2)), into = numbers.point(T(0), T(1));
        // Every third ray aims at a vertex, where the answer depends on the last bit.
        const Vec<T, 3> to = i % 3 == 0 ? mesh.vertices[numbers.below(mesh.vertices.size())] : into;
        const auto hit = closest_hit(index, {from, to - from});
        hits += bool(hit);
        hash.add(hit.t), hash.add(hit.u), hash.add(hit.v), hash.add(hit.element);
        if (i % 3 != 1) continue;
        const auto near = closest_point(index, from);
        if (!near) std::abort();
        hash.add(near.distance2), hash.add(near.element);
        for (int axis = 0; axis < 3; ++axis) hash.add(near.point[axis]);
    }
    std::printf("%s %d %016llx\n", name, hits, hash.value());
}

template <class T>
void structures() {
    Numbers<T> numbers;
    const auto mesh = scene(numbers);
    answers("bvh", build<Bvh>(mesh), mesh, numbers);
    answers("kdtree", build<KdTree>(mesh), mesh, numbers);
    answers("grid", build<Grid>(mesh), mesh, numbers);
    answers("octree", build<Orthtree>(mesh), mesh, numbers);
}

}  // namespace

int main() {
    products<float>();
    products<double>();
    structures<float>();
    structures<double>();
    default_executor().both([] {}, [] {});  // links the compiled core
}
