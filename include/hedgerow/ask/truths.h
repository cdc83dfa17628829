/// Where the truth values of a batch are written.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace hedgerow {

/// The caller's array of truth values: `bool[]`, bytes that become 0 or 1, or a `std::vector<bool>`, whose
/// bits are set once all answers are found.
class Truths {
public:
    // NOLINTBEGIN(google-explicit-constructor): an array of any of these will do
    template <class R>
    requires std::convertible_to<R, std::span<bool>> Truths(R&& flags)
        : Truths(std::span<bool>(flags).data(), std::span<bool>(flags).size()) {}
    template <class R>
    requires std::convertible_to<R, std::span<std::uint8_t>> Truths(R&& bytes)
        : Truths(std::span<std::uint8_t>(bytes)) {}
    Truths(std::span<std::uint8_t> bytes) : Truths(reinterpret_cast<bool*>(bytes.data()), bytes.size()) {
        static_assert(sizeof(bool) == 1);
    }
    Truths(std::vector<bool>& bits) : bits_(&bits), size_(bits.size()) {}
    Truths(bool* flags, std::size_t size) : flags_(flags), size_(size) {}
    // NOLINTEND(google-explicit-constructor)

    std::size_t size() const { return size_; }
    /// Calls f with an array for `count` values, and returns what it returns.
    template <class F>
    auto written(std::size_t count, F f) const {
        if (bits_ == nullptr) return f(flags_);
        const auto flags = std::make_unique<bool[]>(count);
        const auto result = f(flags.get());
        for (std::size_t i = 0; i < count; ++i) (*bits_)[i] = flags[i];
        return result;
    }

private:
    bool* flags_ = nullptr;
    std::vector<bool>* bits_ = nullptr;
    std::size_t size_;
};

}  // namespace hedgerow
