/// Executors, which run parallel work: by oneTBB, in the calling thread (serial), or in the caller's own
/// pool.
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace hedgerow {

/// A reference to a callable, which must outlive the reference.
template <class Signature>
class FunctionRef;
template <class R, class... Args>
class FunctionRef<R(Args...)> {
public:
    template <class F>
    requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef>)
        FunctionRef(F&& f)  // NOLINT(bugprone-forwarding-reference-overload): constrained
        : object_(const_cast<void*>(static_cast<const void*>(&f))), call_([](void* o, Args... args) -> R {
              return (*static_cast<std::remove_reference_t<F>*>(o))(std::forward<Args>(args)...);
          }) {}
    R operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

private:
    void* object_;
    R (*call_)(void*, Args...);
};

/// The least number of primitives that is worth a task of its own.
inline constexpr std::size_t worth_a_task = 4096;

/// Runs parallel work. To use a pool of your own, derive from Executor and implement its two functions,
/// `for_each_piece` and `both`. Each returns when all its work is done, and lets the first exception through.
/// Results never depend on how the work is cut or on the number of threads. WatchedExecutor adds progress
/// reports and cancellation to any executor.
class Executor {
public:
    virtual ~Executor() = default;
    /// Calls body(begin, end) for pieces of about `grain` that together are [0, count), in any order.
    virtual void for_each_piece(std::size_t count, std::size_t grain,
                                FunctionRef<void(std::size_t, std::size_t)> body) = 0;
    /// Calls both functions, perhaps at the same time.
    virtual void both(FunctionRef<void()> first, FunctionRef<void()> second) = 0;

    /// Progress of long work. `expect` announces how much there is to do, in primitives that take one step
    /// each. `advance` reports, about every 4096 of them, how many more are done. Overrides may throw, which
    /// ends the work.
    virtual void expect(std::size_t work) { static_cast<void>(work); }
    virtual void advance(std::size_t work) { static_cast<void>(work); }
    /// A place where serial work may be stopped, for work that is a small share of the whole.
    void look() { advance(0); }
};

/// Runs everything in the calling thread.
class SerialExecutor final : public Executor {
public:
    void for_each_piece(std::size_t count, std::size_t,
                        FunctionRef<void(std::size_t, std::size_t)> body) override {
        if (count > 0) body(0, count);
    }
    void both(FunctionRef<void()> first, FunctionRef<void()> second) override {
        first();
        second();
    }
};
inline SerialExecutor& serial_executor() {
    static SerialExecutor serial;
    return serial;
}

/// The executor that uses all cores by oneTBB (serial, if the library was built without oneTBB). In the
/// library `core`.
Executor& default_executor();

/// The executor that uses at most so many threads of those of `default_executor()`; 0 means all of them. It
/// lives as long as the program. In the library `core`.
Executor& executor_of(std::size_t threads);

/// Whether the calling thread is running a task of `default_executor()`. In the library `core`.
bool is_worker();

/// Which threads a call runs on: those of the caller's executor, or at most so many, or all. A call uses
/// the caller's executor for whatever work. Without one, it uses other threads for at least `worth_a_task`
/// items; it stays in the calling thread for fewer items, and inside a worker, since other workers have the
/// other cores.
///
///   closest_hits(index, rays, hits, {.threads = 4});
///   closest_hits(index, rays, hits, {.threads = my_pool});
class Threads {
public:
    Threads() = default;
    Threads(Executor& given)  // NOLINT(google-explicit-constructor): an executor will do
        : given_(&given), chosen_(true) {}
    /// At most so many threads; 0 or less means all.
    template <std::integral Number>
    Threads(Number most)  // NOLINT: a number too
        : most_(most > 0 ? static_cast<std::size_t>(most) : 0), chosen_(true) {}

    /// Whether they are the caller's choice.
    bool chosen() const { return chosen_; }
    Executor& over(std::size_t items) const {
        if (given_ != nullptr) return *given_;
        if (items < worth_a_task || is_worker()) return serial_executor();
        return most_ == 0 ? default_executor() : executor_of(most_);
    }

private:
    Executor* given_ = nullptr;
    std::size_t most_ = 0;
    bool chosen_ = false;
};

/// Limits oneTBB to a number of threads for as long as the object lives; 0 means all cores. Has no effect if
/// the library was built without oneTBB.
class ThreadLimit {
public:
    explicit ThreadLimit(unsigned threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    void* control_ = nullptr;
};

}  // namespace hedgerow
