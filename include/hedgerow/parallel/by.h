/// Options with threads of one's own.
#pragma once

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// A copy of options, with the threads to use: `render(index, mesh, by(serial_executor(), options))`.
template <class Options>
Options by(Threads threads, Options options) {
    options.threads = threads;
    return options;
}

}  // namespace hedgerow
