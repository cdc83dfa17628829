// Prints the bits of what the geometry headers compute for fixed inputs, to be compared between builds of it.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <random>

#include <hedgerow/hedgerow.h>

using namespace hedgerow;

namespace {

void print(float x) {
    std::printf("%08x ", std::bit_cast<std::uint32_t>(x));
}
void print(double x) {
    std::printf("%016llx ", static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(x)));
}

// Products of nearly equal size, whose difference shows whether they were rounded before it was taken.
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

}  // namespace

int main() {
    products<float>();
    products<double>();
    default_executor().both([] {}, [] {});  // what is compiled links
}
