// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cpp/src/endpoint/slot_terms.hpp"

namespace rr::endpoint {
namespace {

// An entry whose elements `write` writes; it says how many these are.
class Written {
 public:
  explicit Written(const std::function<std::uint32_t(Writer&)>& write) {
    Writer writer;
    writer.reset(MessageVersion::v4);
    const std::size_t end = writer.position();
    const std::uint32_t count = write(writer);
    writer.entry({.type = EntryType::wire_connect_req}, count, end);
    writer.message({}, 1);
    bytes_ = writer.copy();
    EXPECT_TRUE(read_message(bytes_, {}, false, message_, entry_));
  }
  [[nodiscard]] std::optional<SlotMode> mode(std::string_view name) const {
    Decoder decoder(message_.version, &message_.strings);
    return find_slot_mode(decoder, entry_, name);
  }
  [[nodiscard]] SlotTerms slots() const {
    Decoder decoder(message_.version, &message_.strings);
    return find_slots(decoder, entry_);
  }

 private:
  std::vector<std::byte> bytes_;
  Message message_;
  Entry entry_;
};

Written with_mode(std::string_view name, std::uint32_t mode) {
  return Written([&](Writer& writer) {
    const std::size_t end = writer.position();
    writer.prepend_bytes(&mode, sizeof mode);
    writer.element(name, ElementType::uint32, {}, 1, end);
    return 1U;
  });
}

TEST(SlotTerms, AModeIsFoundByItsName) {
  EXPECT_EQ(with_mode(slots_element, 2).mode(slots_element), SlotMode::woken);
  EXPECT_EQ(with_mode(slots_element, 0).mode(slots_element), SlotMode::messages);
  EXPECT_EQ(with_mode(slots_element, 1).mode(slots_again_element), std::nullopt);
  EXPECT_EQ(with_mode(slots_again_element, 1).mode(slots_again_element), SlotMode::polled);
}

TEST(SlotTerms, WhatIsNoModeIsNone) {
  EXPECT_EQ(with_mode(slots_element, 3).mode(slots_element), std::nullopt);
  EXPECT_EQ(with_mode(slots_element, ~0U).mode(slots_element), std::nullopt);
  const Written empty([](Writer&) { return 0U; });
  EXPECT_EQ(empty.mode(slots_element), std::nullopt);
  const Written text([](Writer& writer) {
    writer.string_element(slots_element, "1234");
    return 1U;
  });
  EXPECT_EQ(text.mode(slots_element), std::nullopt);
  const Written two([](Writer& writer) {
    const std::size_t end = writer.position();
    const std::uint32_t modes[] = {1, 1};
    writer.prepend_bytes(modes, sizeof modes);
    writer.element(slots_element, ElementType::uint32, {}, 2, end);
    return 1U;
  });
  EXPECT_EQ(two.mode(slots_element), std::nullopt);
}

TEST(SlotTerms, WhatAServiceAnswersIsWrittenAndFound) {
  constexpr std::uint64_t id = 0x0123456789ABCDEF;
  for (const std::optional<std::uint32_t> holds : {std::optional<std::uint32_t>(), {0}, {47}}) {
    const Written answer([&](Writer& writer) {
      const std::uint32_t count = write_slots(writer, {id, holds});
      EXPECT_EQ(count, holds ? 2U : 1U);
      return count;
    });
    EXPECT_EQ(answer.slots().id, id);
    EXPECT_EQ(answer.slots().holds, holds);
  }
  EXPECT_EQ(with_mode(slots_element, 1).slots().id, 0U);
  EXPECT_EQ(with_mode(holds_element, 1).slots().holds, std::nullopt) << "of no memory";
  EXPECT_EQ(Written([](Writer&) { return 0U; }).slots().id, 0U);
}

}  // namespace
}  // namespace rr::endpoint
