/// A set of any primitives behind virtual calls, so that the build of a structure is compiled once for all
/// sets.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

#include <hedgerow/structures/cells.h>

namespace hedgerow::detail {

/// A test of cells that `stands_in` prepared for one primitive of a set.
template <std::floating_point T, int D>
class StandingTest {
    static constexpr std::size_t room = 1024;

public:
    using Cell = Box<T, D>;
    template <class Test>
    static constexpr bool fits = sizeof(Test) <= room &&
                                 alignof(Test) <= alignof(double) && std::is_trivially_copyable_v<Test>;

    template <class Test>
    requires(fits<Test>) explicit StandingTest(const Test& test)
        : test_([](const std::byte* kept, const Cell& cell) -> bool {
              return (*std::launder(reinterpret_cast<const Test*>(kept)))(cell);
          }) {
        ::new (static_cast<void*>(kept_)) Test(test);
    }
    bool operator()(const Cell& cell) const { return test_(kept_, cell); }

private:
    bool (*test_)(const std::byte*, const Cell&);
    alignas(double) std::byte kept_[room];
};

/// What structures ask of a set while they are built, changed or validated. It is a PrimitiveSet, whose tests
/// of cells (cells.h) are those of the set behind it.
template <std::floating_point T, int D>
class AnySet {
public:
    using Scalar = T;
    static constexpr int dimension = D;

    virtual std::size_t size() const = 0;
    virtual Box<T, D> bounds(std::size_t i) const = 0;
    virtual bool finite(std::size_t i) const = 0;
    virtual void validate() const = 0;
    virtual void validate(std::size_t i) const = 0;
    virtual bool hits_lie_on() const = 0;
    virtual StandingTest<T, D> stands_in(PrimitiveId id) const = 0;
    virtual Box<T, D> part_in(PrimitiveId id, const Box<T, D>& cell) const = 0;
    virtual hedgerow::Corners<T, D> corners_in(PrimitiveId id) const = 0;
    /// Whether the primitives are points, and whether they are placed indexes.
    virtual bool of_points() const = 0;
    virtual bool instanced() const = 0;

protected:
    ~AnySet() = default;
};
/// A set of points, for structures that hold nothing else.
template <std::floating_point T, int D>
class AnyPoints : public AnySet<T, D> {
public:
    Vec<T, D> point(std::size_t i) const { return this->bounds(i).low; }

protected:
    ~AnyPoints() = default;
};

/// A set of known type as an AnySet. The set must outlive it.
template <PrimitiveSet P>
class SetBehind final : public AnyPoints<typename P::Scalar, P::dimension> {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;

    explicit SetBehind(const P& set) : set_(set) {}

    std::size_t size() const override { return set_.size(); }
    Box<T, D> bounds(std::size_t i) const override { return set_.bounds(i); }
    bool finite(std::size_t i) const override {
        if constexpr (requires { set_.finite(i); })
            return set_.finite(i);
        else
            return static_cast<void>(i), true;
    }
    void validate() const override {
        if constexpr (requires { set_.validate(); }) set_.validate();
    }
    void validate(std::size_t i) const override {
        if constexpr (requires { set_.validate(i); })
            set_.validate(i);
        else
            static_cast<void>(i);
    }
    bool hits_lie_on() const override { return hedgerow::hits_lie_on(set_); }
    StandingTest<T, D> stands_in(PrimitiveId id) const override {
        if constexpr (StandingTest<T, D>::template fits<decltype(hedgerow::stands_in(set_, id))>)
            return StandingTest<T, D>(hedgerow::stands_in(set_, id));
        else
            return StandingTest<T, D>(
                [this, id](const Box<T, D>& cell) -> bool { return hedgerow::stands_in(set_, id)(cell); });
    }
    Box<T, D> part_in(PrimitiveId id, const Box<T, D>& cell) const override {
        return hedgerow::part_in(set_, id, cell);
    }
    hedgerow::Corners<T, D> corners_in(PrimitiveId id) const override {
        return hedgerow::corners_in(set_, id);
    }
    bool of_points() const override { return PointSet<P>; }
    bool instanced() const override { return Instanced<P>; }

private:
    const P& set_;
};

}  // namespace hedgerow::detail
