/// Who runs parallel work: oneTBB, nobody (serial), or the caller's own pool.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace hedgerow {

/// A reference to something callable; the callable must outlive it.
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

/// Primitives in a piece of work that is worth a task of its own.
inline constexpr std::size_t worth_a_task = 4096;

/// Derive from it to bring a pool of your own: two functions, both of which return when all is done and let
/// the first exception through. Results never depend on how the work is cut or on the number of threads.
/// WatchedExecutor adds progress and a token to stop to any executor.
class Executor {
public:
    virtual ~Executor() = default;
    /// Calls body(begin, end) for pieces of about `grain` that together are [0, count), in any order.
    virtual void for_each_piece(std::size_t count, std::size_t grain,
                                FunctionRef<void(std::size_t, std::size_t)> body) = 0;
    /// Calls both, perhaps at once.
    virtual void both(FunctionRef<void()> first, FunctionRef<void()> second) = 0;

    /// Long work announces here how much there is to do, in primitives that take one step each; and says,
    /// about every 4096 of them, how much is done. Overrides may throw, which ends the work.
    virtual void expect(std::size_t work) { static_cast<void>(work); }
    virtual void advance(std::size_t work) { static_cast<void>(work); }
    /// For serial work whose share of the whole is small: a place where it may be stopped.
    void look() { advance(0); }
};

/// Everything in the calling thread.
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

/// oneTBB on all cores (serial, if the library was built without it). In the library `core`.
Executor& default_executor();

/// oneTBB limited to a number of threads for as long as it lives; 0 means all cores.
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
