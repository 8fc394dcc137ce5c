// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/listeners.hpp"

#include <utility>

namespace rr::matlab {

void Listeners::tell(const std::shared_ptr<Listeners>& listeners,
                     std::function<std::vector<mxArray*>()> make) {
  listeners->queue_->push([listeners, make = std::move(make)] { listeners->call(make); });
}

void Listeners::tell_last(const std::shared_ptr<Listeners>& listeners,
                          std::function<std::vector<mxArray*>()> make) {
  listeners->queue_->push([listeners, make = std::move(make)] {
    listeners->call(make);
    for (const std::uint64_t number : std::exchange(listeners->functions_, {})) {
      listeners->runtime_.functions().remove(number);
    }
  });
}

// A function that is called may end another, or add one.
void Listeners::call(const std::function<std::vector<mxArray*>()>& make) {
  std::erase_if(functions_,
                [&](std::uint64_t number) { return runtime_.functions().find(number) == nullptr; });
  const std::vector<std::uint64_t> numbers = functions_;
  for (const std::uint64_t number : numbers) {
    const UserFunction* const function = runtime_.functions().find(number);
    if (function != nullptr) UserFunctions::run_alone(function->function, make());
  }
}

}  // namespace rr::matlab
