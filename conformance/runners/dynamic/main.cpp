// SPDX-License-Identifier: Apache-2.0
// The runner of the dynamic client and service.
#include <iostream>

#include "conformance/runners/dynamic/notation.hpp"
#include "conformance/runners/dynamic/verbs.hpp"

namespace rr::conformance {

dynamic::Value passed(const dynamic::Definitions&, const dynamic::ValueType&,
                      const dynamic::Value& value) {
  return value;
}

}  // namespace rr::conformance

int main(int argc, char** argv) {
  if (argc == 3 && rr::conformance::answer_verb(argv[2], argv[1])) return 0;
  std::cerr << "usage: conformance_dynamic_runner DEFINITIONS decode|encode|serve|call|both\n";
  return 2;
}
