#pragma once

// OpenNI2's driver interface expects two macros of a library that is not shipped with it.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)

#include <Driver/OniDriverAPI.h>
