/// Other ray tracers that answer the same rays. They are there if they were found when the build was
/// configured; no part of the library needs one.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/geometry/ray.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/structures/bvh/wide/build.h>

namespace hedgerow::benchmark {

/// One of a peer's ways to build, by its own name.
struct PeerBuild {
    std::string name;
    WideBuilder like;     ///< which of ours it is the like of
    bool robust = false;  ///< as it builds and answers for who needs watertight meshes
};

/// What a peer has built. It is asked by one thread, and counts the rays that hit.
class PeerIndex {
public:
    /// Rays in the peer's own layout, by sixteen; the last that do not fill one are left out.
    class Packets {
    public:
        virtual ~Packets() = default;
    };

    virtual ~PeerIndex() = default;
    virtual std::size_t closest(std::span<const Ray3f> rays) const = 0;
    virtual std::size_t any(std::span<const Ray3f> rays) const = 0;
    virtual std::unique_ptr<Packets> packets(std::span<const Ray3f> rays) const = 0;
    /// By calls of sixteen, told that they are coherent. Only the first of each sixteen is counted.
    virtual std::size_t closest(const Packets& packets) const = 0;
    virtual std::size_t any(const Packets& packets) const = 0;

    /// The closest hit, infinity if there is none.
    virtual float distance(const Ray3f& ray) const = 0;
    virtual bool hits(const Ray3f& ray) const = 0;

    double build_seconds = 0;               ///< on the clock of the whole process
    std::size_t bytes = 0, most_bytes = 0;  ///< at the end, and at most during the build
};

class Peer {
public:
    virtual ~Peer() = default;
    virtual std::string name() const = 0;
    virtual std::string version() const = 0;
    virtual std::vector<PeerBuild> builds() const = 0;
    /// On one thread, with no more than the instruction set of that name (kernels.h).
    virtual std::unique_ptr<PeerIndex> build(const TriangleMesh<float>& mesh, const PeerBuild& how,
                                             std::string_view instruction_set) const = 0;
};

/// Those that are there.
std::vector<std::unique_ptr<Peer>> peers();

/// The peer's build of that name. The peer must have it.
PeerBuild build_named(const Peer& peer, std::string_view name);
/// What one of our builders is held against: its like, where there is none the medium one.
PeerBuild build_like(const Peer& peer, WideBuilder builder);

/// Seconds of a build, the median.
double build_seconds(const Peer& peer, const TriangleMesh<float>& mesh, int repeats);

}  // namespace hedgerow::benchmark
