// SPDX-License-Identifier: Apache-2.0
// Keeps a sketch from being dropped by the linker.
#include <Arduino.h>

// Asked for by sketches with objects that have a destructor.
extern "C" {
__attribute__((visibility("hidden"))) void* __dso_handle = nullptr;
}

int main() {
  setup();
  for (;;) loop();
}
