/// Welding by a hash of the corners.
#include "welding.h"

#include <bit>

#include <hedgerow/scenes/random.h>

#include "steps.h"

namespace hedgerow::detail {

std::size_t WeldedMesh::Hash::operator()(const Vec3d& p) const {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) h = scattered(h + std::bit_cast<std::uint64_t>(p[i]));
    return static_cast<std::size_t>(h);
}

std::uint32_t WeldedMesh::vertex(const Vec3d& p) {
    const Vec3d q = p + Vec3d();  // −0 + 0 is 0
    const auto [place, is_new] = known_.try_emplace(q, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(q);
    return place->second;
}

void WeldedMesh::add(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    step(progress_, before_ + mesh.triangles.size(), total_);
    if (!(length2(Triangle<double, 3>{a, b, c}.normal()) > 0)) return;
    const std::uint32_t i = vertex(a), k = vertex(b), l = vertex(c);
    mesh.triangles.push_back({i, k, l});
}

void WeldedMesh::add_quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    add(a, b, c);
    add(a, c, d);
}

namespace {
/// Point i of the n + 1 that divide a-b evenly; the same bits from either end.
Vec3d between(const Vec3d& a, const Vec3d& b, std::uint32_t i, std::uint32_t n) {
    return a * (static_cast<double>(n - i) / n) + b * (static_cast<double>(i) / n);
}
}  // namespace

void WeldedMesh::add_divided_quad(const std::array<Vec3d, 4>& corners, std::uint32_t across,
                                  std::uint32_t along) {
    const auto& [a, b, c, d] = corners;
    std::vector<Vec3d> last, row(across + 1);
    for (std::uint32_t k = 0; k <= along; ++k) {
        const Vec3d left = between(a, d, k, along), right = between(b, c, k, along);
        for (std::uint32_t i = 0; i <= across; ++i) row[i] = between(left, right, i, across);
        for (std::uint32_t i = 0; k > 0 && i < across; ++i)
            add_quad(last[i], last[i + 1], row[i + 1], row[i]);
        last = row;
    }
}

void append(TriangleMesh<double>& whole, const TriangleMesh<double>& part, const Vec3d& offset) {
    const auto first = static_cast<std::uint32_t>(whole.vertices.size());
    for (const Vec3d& p : part.vertices) whole.vertices.push_back(p + offset);
    for (const TriangleIndices& t : part.triangles)
        whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace hedgerow::detail
