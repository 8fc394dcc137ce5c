// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "example/mount.hpp"
#include "example/other.hpp"

int main() {
  example::base::Angles angles;
  angles.pan = 0.25;
  example::other::Reading reading;
  reading.number = 7;
  std::printf("pan %.2f, number %d\n", angles.pan, static_cast<int>(reading.number));
  return 0;
}
