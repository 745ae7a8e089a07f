// What the shared library shows.
#pragma once

#define EDGESLAM_PUBLIC __attribute__((visibility("default")))
