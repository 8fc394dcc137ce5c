// SPDX-License-Identifier: Apache-2.0
// The smallest client: one property of one object.
#include <iostream>

#include "experimental/one.hpp"
#include "rr/node.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    rr::Node node;
    std::cout << node.connect<experimental::one::CounterStub>(argv[1])->get_total() << '\n';
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
