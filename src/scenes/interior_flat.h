/// The plan of the flat, and the place of each thing in it.
#pragma once

#include <functional>
#include <vector>

#include "interior_things.h"

namespace hedgerow::detail {

/// Adds a thing to a model, with random numbers of its own.
using Thing = std::function<void(Model&, Random)>;

/// All things, in the order of their importance: the shell, what closes its openings, furniture, mouldings,
/// and small things.
std::vector<Thing> flat();

}  // namespace hedgerow::detail
