// Names and advice of the statuses.
#pragma once

#include <beltrami/beltrami.h>

namespace beltrami {

/// "BELTRAMI_E_CLOSED"; "unknown" for numbers that are no status. Static.
const char* status_name(beltrami_status status);

/// One sentence on the meaning and the remedy; never null. Static.
const char* status_advice(beltrami_status status);

}  // namespace beltrami
