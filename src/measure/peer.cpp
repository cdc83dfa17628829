#include <hedgerow/measure/peer.h>

#include <algorithm>

#include <hedgerow/measure/contest.h>

namespace hedgerow::measure {

PeerBuild build_named(const Peer& peer, std::string_view name) {
    const auto all = peer.builds();
    return *std::find_if(all.begin(), all.end(), [&](const PeerBuild& b) { return b.name == name; });
}

PeerBuild build_like(const Peer& peer, WideBuilder builder) {
    const auto all = peer.builds();
    const auto like = [&](WideBuilder wanted) {
        return std::find_if(all.begin(), all.end(),
                            [&](const PeerBuild& b) { return !b.robust && b.like == wanted; });
    };
    const auto found = like(builder);
    return found != all.end() ? *found : *like(WideBuilder::medium);
}

double build_seconds(const Peer& peer, const TriangleMesh<float>& mesh, int repeats) {
    std::vector<double> times(static_cast<std::size_t>(repeats));
    for (double& time : times)
        time = peer.build(mesh, build_like(peer, WideBuilder::medium), {})->build_seconds;
    return median(times);
}

}  // namespace hedgerow::measure
