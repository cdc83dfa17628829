/// For tests of structures that change: a set, an index over it, and a brute-force index to compare with.
#pragma once

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"
#include "generated.h"

namespace hedgerow::changes {

using namespace contract;
using namespace generated;

/// A set that changes, and two indexes that follow: one of the structure under test and one of brute force.
template <template <class, int> class S, class P>
struct Both {
    using Tree = S<typename P::Scalar, P::dimension>;
    using Item = std::remove_cvref_t<decltype(items(std::declval<P&>())[0])>;
    P set;
    Index<Tree, ViewOf<P>> tree;
    Index<BruteForce<typename P::Scalar, P::dimension>, ViewOf<P>> oracle;

    explicit Both(P start, const typename Tree::Options& options = {})
        : set(std::move(start)),
          tree(build<S>(set, options, default_executor())),
          oracle(build<BruteForce>(set)) {}

    /// Each of the changes below returns whether both indexes returned the same.
    bool insert(PrimitiveId id) { return tree.insert(set, id) == oracle.insert(set, id); }
    bool erase(PrimitiveId id) { return tree.erase(set, id) == oracle.erase(set, id); }
    bool append(const Item& item) {
        items(set).push_back(item);
        return insert(static_cast<PrimitiveId>(set.size() - 1)) && tree.structure().holds(last());
    }
    bool move(PrimitiveId id, const Item& to) {
        if (!erase(id)) return false;
        items(set)[id] = to;
        return insert(id);
    }
    bool same(const Questions<typename P::Scalar, P::dimension>& questions) const {
        return answers(tree, questions) == answers(oracle, questions);
    }
    PrimitiveId last() const { return static_cast<PrimitiveId>(set.size() - 1); }
};

/// Makes a change of one of four kinds: append, move, insert or erase. Returns whether both indexes agree on
/// it.
template <template <class, int> class S, class P>
bool change(Both<S, P>& both, int kind, std::uint64_t which, const typename Both<S, P>::Item& item) {
    if (kind == 0 || both.set.size() == 0) return both.append(item);
    const auto id = static_cast<PrimitiveId>(which % both.set.size());
    switch (kind) {
        case 1:
            return both.move(id, item);
        case 2:
            return both.insert(id);  // often already inserted
        default:
            return both.erase(id);  // often not inserted
    }
}

/// Calls f with a name and a set of each kind, of about `size` primitives.
template <class T, class F>
void with_scenes(std::size_t size, F f) {
    f("teapot", teapot<T>(size));
    f("soup", soup<T>(size));
    f("terrain", terrain<T>(size));
    f("spheres", spheres<T>(size));
    f("points", points<T>(size));
    f("points in the plane", points2d<T>(size));
    f("clusters in the plane", clusters2d<T>(size));
    f("segments", segments2d<T>(size));
}

}  // namespace hedgerow::changes
