/// Checksums of large files: one for each MiB, so that they can be computed in parallel and show where damage
/// is.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace hedgerow::detail {

/// XXH3 of 64 bits (Collet, xxhash.com).
inline std::uint64_t checksum(const void* bytes, std::size_t size) {
    return XXH3_64bits(bytes, size);
}

/// The checksum of bytes that are added one after the other.
class RunningChecksum {
public:
    RunningChecksum() { XXH3_64bits_reset(&state_); }
    void add(const void* bytes, std::size_t size) { XXH3_64bits_update(&state_, bytes, size); }
    std::uint64_t value() const { return XXH3_64bits_digest(&state_); }

private:
    XXH3_state_t state_;
};

inline constexpr std::size_t checksum_piece = std::size_t(1) << 20;
constexpr std::uint64_t checksum_pieces(std::uint64_t bytes) {
    return (bytes + checksum_piece - 1) / checksum_piece;
}

/// Computes the checksums of bytes that are added one after the other.
class Checksums {
public:
    Checksums() { XXH3_64bits_reset(&state_); }

    void add(const void* bytes, std::size_t size) {
        const auto* from = static_cast<const std::byte*>(bytes);
        while (size > 0) {
            const std::size_t n = std::min(size, checksum_piece - filled_);
            XXH3_64bits_update(&state_, from, n);
            from += n, size -= n, filled_ += n;
            if (filled_ == checksum_piece) end_piece();
        }
    }
    /// The checksums of all pieces, once all bytes were added.
    const std::vector<std::uint64_t>& finish() {
        if (filled_ > 0) end_piece();
        return done_;
    }

private:
    void end_piece() {
        done_.push_back(XXH3_64bits_digest(&state_));
        XXH3_64bits_reset(&state_);
        filled_ = 0;
    }

    XXH3_state_t state_;
    std::size_t filled_ = 0;
    std::vector<std::uint64_t> done_;
};

}  // namespace hedgerow::detail
