/// Working memory of queries, which a thread keeps from one query to the next.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace hedgerow {

/// An object that the thread keeps, with the memory that it has, for as long as the Scratch lives. A Scratch
/// that is made while others of the thread live gets an object of its own: filters, own primitives and
/// executors may query again in the middle of a query. A thread's Scratches end in the reverse order of their
/// beginning, as local variables do. The contents are those that the last user left.
template <class V>
class Scratch {
public:
    Scratch() {
        Kept& kept = of_thread();
        if (kept.used == kept.objects.size()) kept.objects.push_back(std::make_unique<V>());
        object_ = kept.objects[kept.used++].get();
    }
    ~Scratch() { --of_thread().used; }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    V& operator*() const { return *object_; }
    V* operator->() const { return object_; }

private:
    struct Kept {
        std::vector<std::unique_ptr<V>> objects;
        std::size_t used = 0;
    };
    static Kept& of_thread() {
        static thread_local Kept kept;
        return kept;
    }

    V* object_;
};

}  // namespace hedgerow
