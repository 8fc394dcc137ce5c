// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/carrier.hpp"

/// The stream of JetStream that has retained messages: the newest of each subject below `rrkept`,
/// which it publishes below `rr` once it has stored it. Texts of its interface are JSON.
namespace rr::gateway {

/// Its name.
inline constexpr std::string_view kept_stream = "RRKEPT";
/// All that is answered while there is no such stream.
inline constexpr int stream_not_found = 10'059;

/// Where it is made.
std::string stream_create_subject();
/// What it is made with. `replicas` is the number of servers of a cluster that have it.
std::string stream_create_text(int replicas);

/// Where a reader of the newest messages is made. The subjects are in the subject, so that the
/// broker can hold users to it.
std::string reader_create_subject(std::string_view name, std::string_view kept_filter);
/// What it is made with: messages go to `inbox`, and nothing is confirmed.
std::string reader_create_text(std::string_view name, std::string_view kept_filter,
                               std::string_view inbox);

/// An answer of JetStream.
struct StreamAnswer {
  int code = 0;                         ///< of an error; 0: it was done
  std::string description;              ///< of an error
  std::uint64_t pending = 0;            ///< of a reader: messages that it will deliver
  std::chrono::nanoseconds created{0};  ///< of a reader: the broker's clock, since 1970
};
/// Nothing for what is none.
std::optional<StreamAnswer> read_answer(const Bytes& payload);

/// What the stream says of a message that a reader delivers, in its reply subject.
struct KeptPlace {
  std::string reader;                  ///< its name
  std::uint64_t number = 0;            ///< in the stream
  std::chrono::nanoseconds stored{0};  ///< when, by the broker's clock, since 1970
};
/// Nothing for another subject.
std::optional<KeptPlace> kept_place(std::string_view reply);

}  // namespace rr::gateway
