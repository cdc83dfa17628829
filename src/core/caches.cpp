#include "caches.h"

std::size_t hedgerow::nodes_at_hand() {
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__))
    static const bool is_first_zen = [] {
        __builtin_cpu_init();
        return __builtin_cpu_is("znver1") != 0;
    }();
    if (is_first_zen) return std::size_t{192} << 10;
#endif
    return std::size_t{4} << 10;
}
