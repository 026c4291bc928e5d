#pragma once

#include "core/vec.h"

// httplib.h brings a macro of the resolver, `_res`, that Eigen's headers must not meet: they come first.

#include <httplib.h>
