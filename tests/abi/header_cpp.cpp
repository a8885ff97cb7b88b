// The header first and alone in C++.
#include <beltrami/beltrami.h>

static_assert(BELTRAMI_ABI == 1, "a break of the ABI: see abi/README.md");
static_assert(BELTRAMI_NO_ELEMENT == ~0ull, "all bits set");
