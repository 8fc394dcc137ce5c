// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cpp/models/model.hpp"
#include "runtime/cpp/models/orders.hpp"

namespace rr::models {
namespace {

constexpr const char* usage =
    "usage: rr_models [--iterations N | --all] [--model NAME] [--planted | --orders]\n"
    "  --iterations N  so many interleavings of each model, chosen at random (100000)\n"
    "  --all           all interleavings, of models that have few\n"
    "  --model NAME    this model alone\n"
    "  --planted       models with a fault each, which must be found\n"
    "  --orders        each memory order weaker than it is written, one after the other: is that "
    "found?\n";

struct Options {
  Extent extent{.iterations = 100'000};
  std::string_view model;
  bool is_planted = false;
  bool asks_orders = false;
};

[[noreturn]] void refuse() {
  std::fputs(usage, stderr);
  std::exit(2);
}

std::uint64_t number_of(const std::string& text) {
  char* end = nullptr;
  const std::uint64_t number = std::strtoull(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || number == 0) refuse();
  return number;
}

Options read(const std::vector<std::string_view>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const bool has_value = i + 1 < arguments.size();
    if (arguments[i] == "--all") {
      options.extent.is_all = true;
    } else if (arguments[i] == "--planted") {
      options.is_planted = true;
    } else if (arguments[i] == "--orders") {
      options.asks_orders = true;
    } else if (arguments[i] == "--iterations" && has_value) {
      options.extent.iterations = number_of(std::string(arguments[++i]));
    } else if (arguments[i] == "--model" && has_value) {
      options.model = arguments[++i];
    } else {
      refuse();
    }
  }
  return options;
}

std::vector<Model> all_models() {
  std::vector<Model> all;
  for (const auto& models :
       {polling_models(), caller_models(), gathering_models(), strand_models(), newest_models(),
        exchange_models(), ring_models(), slot_models(), pipe_ring_models()}) {
    all.insert(all.end(), models.begin(), models.end());
  }
  return all;
}

// The second line of what Relacy says; the first one is the name of a class.
std::string reason_of(const Outcome& outcome) {
  const std::size_t begin = outcome.said.find('\n') + 1;
  return outcome.is_right ? "" : outcome.said.substr(begin, outcome.said.find('\n', begin) - begin);
}

// Whether the model is as it should be.
bool run(const Model& model, const Extent& extent) {
  const auto begin = std::chrono::steady_clock::now();
  const Outcome outcome = model.run(extent);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const std::string name(model.name);
  if (model.fault.empty()) {
    std::printf("%s: %llu interleavings%s in %.1f s: %s\n", name.c_str(),
                static_cast<unsigned long long>(outcome.iterations), extent.is_all ? " (all)" : "",
                took.count(), outcome.is_right ? "right" : "WRONG");
    if (!outcome.is_right) std::fputs(outcome.said.c_str(), stdout);
    return outcome.is_right;
  }
  std::printf("%s, planted `%s`: %s interleaving %llu: %s\n", name.c_str(),
              std::string(model.fault).c_str(), outcome.is_right ? "NOT FOUND until" : "found by",
              static_cast<unsigned long long>(outcome.iterations), reason_of(outcome).c_str());
  return !outcome.is_right;
}

std::string_view name_of(std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return "relaxed";
    case std::memory_order_consume:
      return "consume";
    case std::memory_order_acquire:
      return "acquire";
    case std::memory_order_release:
      return "release";
    case std::memory_order_acq_rel:
      return "acq_rel";
    case std::memory_order_seq_cst:
      break;
  }
  return "seq_cst";
}

// Says which orders the model needs; what it does not need may be needed elsewhere.
void weaken_orders(const Model& model, const Extent& extent) {
  Orders& orders = Orders::current();
  orders.begin();
  model.run({.iterations = 1000});
  const auto found = orders.end();
  const std::vector<OrderedUse> uses(found.begin(), found.end());
  for (const OrderedUse& use : uses) {
    const std::string_view path = use.file;
    for (const std::memory_order weaker : {std::memory_order_acq_rel, std::memory_order_relaxed}) {
      const bool is_weaker =
          weaker == std::memory_order_relaxed || use.order == std::memory_order_seq_cst;
      if (!is_weaker) continue;
      orders.weaken(use, weaker);
      const Outcome outcome = model.run(extent);
      std::printf("%s, %s:%u:%u, %s as %s: %s\n", std::string(model.name).c_str(),
                  std::string(path.substr(path.rfind('/') + 1)).c_str(), use.line, use.column,
                  std::string(name_of(use.order)).c_str(), std::string(name_of(weaker)).c_str(),
                  outcome.is_right ? "not found" : reason_of(outcome).c_str());
      std::fflush(stdout);
    }
  }
  orders.weaken_none();
}

int run_all(const Options& options) {
  int count = 0;
  bool is_right = true;
  for (const Model& model : all_models()) {
    if (options.is_planted == model.fault.empty()) continue;
    if (!options.model.empty() && options.model != model.name) continue;
    if (options.extent.is_all && !model.has_few_runs) continue;
    ++count;
    if (options.asks_orders) {
      weaken_orders(model, options.extent);
      continue;
    }
    is_right = run(model, options.extent) && is_right;
    std::fflush(stdout);
  }
  if (count == 0) {
    std::fputs("there is no such model\n", stderr);
    return 2;
  }
  return is_right ? 0 : 1;
}

}  // namespace
}  // namespace rr::models

int main(int argc, char** argv) {
  return rr::models::run_all(rr::models::read({argv + 1, argv + argc}));
}
