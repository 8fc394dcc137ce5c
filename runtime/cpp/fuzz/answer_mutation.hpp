// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/cpp/fuzz/message_mutation.hpp"

namespace rr::fuzz {

/// Changes what a service sends: one small change for each code, so that a fuzzer builds up larger
/// ones. The same code always does the same to the same message.
class AnswerMutation {
 public:
  /// `pool` has messages of the service, from which parts are taken.
  AnswerMutation(std::uint32_t code, const std::vector<MessageTree>& pool)
      : random_(code), pool_(&pool) {}

  void mutate(MessageTree& message);
  /// Changes texts only, those of definitions line by line.
  void mutate_texts(MessageTree& message);

 private:
  void mutate_question(EntryTree& entry);
  void mutate_error(EntryTree& entry);
  void grow(std::vector<ElementTree>& elements);
  void mutate_text(ElementTree& element);

  Random random_;
  const std::vector<MessageTree>* pool_;
};

/// Changes a service definition: lines, words, numbers.
std::string mutate_definition(const std::string& text, Random& random);

}  // namespace rr::fuzz
