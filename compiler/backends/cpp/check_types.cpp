// SPDX-License-Identifier: Apache-2.0
// What is correct in a definition but has no C++: reports R0902.
#include "compiler/backends/check_values.hpp"
#include "compiler/backends/cpp/view_parts.hpp"

namespace robdef::cpp {

void check_types(const model::Definition& definition, Report& report) {
  const auto judge = [](const model::Type& type) -> std::string {
    model::Type item = type;
    item.container = model::ContainerForm::none;
    const bool is_contained = type.container != model::ContainerForm::none;
    return is_contained && storage_size(item) > item_limit
               ? "an array of more than 1 MiB in a container"
               : "";
  };
  check_values(definition, {.language = "C++", .judge = judge}, report);
}

}  // namespace robdef::cpp
