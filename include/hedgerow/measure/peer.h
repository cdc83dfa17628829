/// Other ray tracers, which trace the same rays. A peer is whatever implements these interfaces; no part of
/// the library is one or needs one.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/engine/build.h>
#include <hedgerow/geometry/ray.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow::measure {

/// One of a peer's ways to build, by its own name.
struct PeerBuild {
    std::string name;
    WideBuilder like;     ///< our builder that this one is compared with
    bool robust = false;  ///< the peer's variant for callers that need watertight meshes
};

/// An index that a peer has built. One thread queries it. Batch queries return the number of rays that hit.
class PeerIndex {
public:
    /// Rays in the peer's own layout, in packets of sixteen, which the peer is told are coherent or not. Rays
    /// that do not fill the last packet are left out.
    class Packets {
    public:
        virtual ~Packets() = default;
    };

    virtual ~PeerIndex() = default;
    virtual std::size_t closest(std::span<const Ray3f> rays) const = 0;
    virtual std::size_t any(std::span<const Ray3f> rays) const = 0;
    virtual std::unique_ptr<Packets> packets(std::span<const Ray3f> rays, bool coherent) const = 0;
    /// Queries by calls of sixteen rays. Only the first ray of each sixteen is counted.
    virtual std::size_t closest(const Packets& packets) const = 0;
    virtual std::size_t any(const Packets& packets) const = 0;

    /// The t of the closest hit; infinity if there is none.
    virtual float distance(const Ray3f& ray) const = 0;
    virtual bool hits(const Ray3f& ray) const = 0;

    double build_seconds = 0;               ///< processor time of all threads
    std::size_t bytes = 0, most_bytes = 0;  ///< after the build, and the peak during it
};

class Peer {
public:
    virtual ~Peer() = default;
    virtual std::string name() const = 0;
    virtual std::string version() const = 0;
    virtual std::vector<PeerBuild> builds() const = 0;
    /// Builds on one thread, with no more than the instruction set of that name (kernels.h); an empty name
    /// sets no limit.
    virtual std::unique_ptr<PeerIndex> build(const TriangleMesh<float>& mesh, const PeerBuild& how,
                                             std::string_view instruction_set) const = 0;
};

/// The peer's build of that name. The peer must have it.
PeerBuild build_named(const Peer& peer, std::string_view name);
/// The build that one of our builders is compared with: the like one that is not robust, else the medium one.
PeerBuild build_like(const Peer& peer, WideBuilder builder);

/// Seconds of the medium build, the median of `repeats`.
double build_seconds(const Peer& peer, const TriangleMesh<float>& mesh, int repeats);

}  // namespace hedgerow::measure
