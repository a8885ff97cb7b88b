// The header first and alone in C++.
#include <beltrami/beltrami.h>

static_assert(BELTRAMI_ABI == 1, "a break of the ABI needs a new SOVERSION in src/CMakeLists.txt");
static_assert(BELTRAMI_NO_ELEMENT == ~0ull, "all bits set");
