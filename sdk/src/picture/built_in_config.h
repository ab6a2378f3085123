// The configuration that is there without a file.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

namespace etendue {

// Throws OpenColorIO's exceptions.
OCIO_NAMESPACE::ConfigRcPtr built_in_config();

}  // namespace etendue
