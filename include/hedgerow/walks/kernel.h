/// The interface of kernels, which answer a query faster than a walk. An engine implements it; indexes,
/// instances and batches call it.
#pragma once

#include <concepts>
#include <cstddef>

namespace hedgerow {

/// Answers queries Q of an index I without a walk. Empty, unless an engine specialises it for Q and I
/// (engine/ray_kernels.h). A specialisation gives the same bits as the walk. It is asked in IEEE mode, and
/// only where no visits are counted. It has
/// - `explicit operator bool()`: whether the kernel runs on this processor; if not, the walk answers;
/// - `answer(index, arguments...)`: what `Q(index, arguments...)` answers after its walk.
/// It may also have
/// - `single(index)`: a function object that answers one probe after the other, without a filter, as long as
///   the index stays at its address. The caller keeps the thread in IEEE mode;
/// - `answer_many(index, first, probes, answers, filter)`: answers[i] is the answer to probes[i], which is
///   number `first + i` of the batch for the filter. Returns a KernelUse;
/// - `answer_many(index, points, arguments..., answers...)`: answers number n of the answers for point number
///   n of a PointBatch. Returns false, and writes nothing, where the walk has to answer;
/// - `answer_all(index, arguments..., executor, answers)`, or of two indexes, for a question that is asked of
///   the whole. Returns false, and writes nothing, where the walk has to answer;
/// - `offer_inside(index, probe, instance, geometry, query)`: for a query of a world in which `index` is an
///   instance. Offers the candidates that the probe, in the instance's space, finds there, and
///   returns the query's Flow.
template <class Q, class I>
struct Kernel {};

template <class Q, class I>
concept HasKernel = requires(const Kernel<Q, I>& kernel) {
    static_cast<bool>(kernel);
};

/// The data of an instance of an index I that kernels read. Empty, unless an engine specialises it with a
/// type `Instance` and a function `of(index, back, mask, geometry)`.
template <class I>
struct InstanceKernel {
    struct Instance {};
};

/// The number of rays of a batch that each algorithm answered. `single` rays were answered one by one, by a
/// kernel or by a walk; all rays against instances are. `phased` rays were answered in phases over the batch,
/// the others in `packets` of rays that go the same way or, for any hits, through the same region.
struct KernelUse {
    std::size_t single = 0, phased = 0, packets = 0;

    KernelUse& operator+=(const KernelUse& more) {
        single += more.single, phased += more.phased, packets += more.packets;
        return *this;
    }
};

}  // namespace hedgerow
