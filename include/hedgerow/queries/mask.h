/// Primitives that a question sees, by bits.
#pragma once

#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

/// The bits that a question wants: it sees what has one of them. The bits of elements stand in an array, with
/// those of each element of the set; the bits of instances are their own (`Instance::mask`). Every primitive
/// is seen where no mask is given.
///
///   any_hit(index, ray, {.mask = {masks, 0x5}});   // elements with bit 0 or bit 2
///   any_hit(world, ray, {.mask = 0x2});            // instances with bit 1
class Mask {
public:
    Mask() = default;
    /// A mask of instances.
    Mask(std::uint32_t wanted) : wanted_(wanted), given_(true) {}  // NOLINT(google-explicit-constructor)
    /// A mask of elements. Views the array of their bits: a vector, a span, or Strided.
    Mask(const Strided<std::uint32_t>& of_elements, std::uint32_t wanted)
        : of_elements_(of_elements), wanted_(wanted), given_(true), has_elements_(true) {}

    bool none() const { return !given_; }
    bool sees(PrimitiveId element) const { return !has_elements_ || (of_elements_[element] & wanted_) != 0; }
    /// Whether an instance with these bits is queried.
    bool enters(std::uint32_t bits) const { return !given_ || (bits & wanted_) != 0; }
    /// Throws InputError if the mask is not one for the set: of elements among instances, of instances where
    /// there are none, or of fewer elements.
    template <class P>
    void expect(const P& set) const {
        if (!given_) return;
        if (has_elements_ == Instanced<P>)
            throw InputError(has_elements_ ? "masks of elements are those of one set: among instances, give "
                                             "the bits that are wanted alone"
                                           : "a mask needs the bits of the elements: give their array before "
                                             "the bits that are wanted");
        if (has_elements_ && of_elements_.size() < set.size())
            throw InputError("there are " + std::to_string(set.size()) + " primitives, but masks for " +
                             std::to_string(of_elements_.size()) + ": give one for each, or none");
    }

private:
    Strided<std::uint32_t> of_elements_;
    std::uint32_t wanted_ = ~0u;
    bool given_ = false, has_elements_ = false;
};

}  // namespace hedgerow
