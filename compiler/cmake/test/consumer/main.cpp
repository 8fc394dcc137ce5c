// SPDX-License-Identifier: Apache-2.0
#include <rr.h>

#include <cstdio>

#include "example/mount.hpp"
#include "example/other.hpp"

int main() {
  if (rr_abi_version() >> 16 != RR_ABI_VERSION >> 16) return 1;
  example::base::Angles angles;
  angles.pan = 0.25;
  example::other::Reading reading;
  reading.number = 7;
  std::printf("pan %.2f, number %d\n", angles.pan, static_cast<int>(reading.number));
  return 0;
}
