// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/fuzzed_streams.hpp"

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "rr/async.hpp"
#include "rr/error.hpp"
#include "rr/service.hpp"

namespace rr::fuzz {
namespace {

namespace robdef = ::experimental::fuzzed;

robdef::Leaf leaf(std::int32_t number) {
  return {"leaf", robdef::Mode::manual, robdef::Stats{number, 0.5, "stats"}};
}

robdef::Tree tree(std::int32_t number) {
  robdef::Tree tree;
  tree.name = "tree";
  tree.main = leaf(number);
  tree.leaves = {leaf(1), std::nullopt};
  tree.by_name = {{"one", leaf(1)}};
  tree.extra = VarValue(2.5);
  return tree;
}

class StreamBoard final : public robdef::StreamBoardDefault {
 public:
  explicit StreamBoard(std::shared_ptr<const void> life) : life_(std::move(life)) {
    constexpr std::size_t width = 8;
    constexpr std::size_t height = 4;
    rr_memory_bytes = std::make_shared<StoredArrayMemory<std::uint8_t>>(std::size_t{256});
    rr_memory_cells = std::make_shared<StoredArrayMemory<robdef::Sample>>(std::size_t{16});
    rr_memory_grid = std::make_shared<StoredMultiMemory<double>>(
        MultiArray<double>{{width, height}, Array<double>(width * height)});
  }

  Sequence<std::int32_t> count(std::int32_t limit) override {
    for (std::int32_t i = 0; i < limit; ++i) co_yield i;
  }
  Sequence<void, double> take(std::string label) override {
    for (std::size_t left = label.size(); left != 0; --left) co_await taken<double>;
  }
  Sequence<std::optional<robdef::Leaf>, VarValue> exchange() override {
    for (std::int32_t number = 0;; ++number) {
      const VarValue value = co_await taken<VarValue>;
      if (value.is_null()) throw robdef::ProbeFault("no value");
      co_yield leaf(number);
    }
  }

  void fire() override {
    samples().send({1.5, 2.5});
    leaves().send(leaf(3));
    parcels().send(VarValue("parcel"));
    force().set_in({1, 2, 3});
    state().set_in(tree(4));
    blocks().set_in({robdef::Sample{}, robdef::Sample{}});
    fired(5, tree(6));
    // Not waited for: whoever calls may never answer.
    const std::uint32_t client = ServiceContext::current_client();
    async_ask(client, 7, [](std::exception_ptr, std::int32_t) {});
    async_ask_leaf(client, leaf(8), "text",
                   [](std::exception_ptr, const std::optional<robdef::Leaf>&) {});
  }

 private:
  const std::shared_ptr<const void> life_;
};

}  // namespace

std::shared_ptr<robdef::StreamBoardSkeleton> make_fuzzed_streams(std::shared_ptr<const void> life) {
  return std::make_shared<StreamBoard>(std::move(life));
}

}  // namespace rr::fuzz
