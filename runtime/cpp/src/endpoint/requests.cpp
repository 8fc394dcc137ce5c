// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/requests.hpp"

#include "rr/type.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"

namespace rr::endpoint {

EntryHeader answer_header(const Entry& request, ErrorCode error) {
  return {.type = static_cast<EntryType>(
              static_cast<std::uint16_t>(static_cast<std::uint16_t>(request.type) + 1)),
          .service_path = request.service_path,
          .member = request.member,
          .request_id = request.request_id,
          .error = static_cast<std::uint16_t>(error)};
}

[[gnu::hot]] channel::Priority priority_of(EntryType type, bool is_urgent) {
  switch (type) {
    case EntryType::client_session_op_req:
    case EntryType::client_session_op_ret:
    case EntryType::service_path_released_req:
      return channel::Priority::fixed;
    default:
      if (static_cast<std::uint16_t>(type) < 500) return channel::Priority::fixed;
      return is_urgent ? channel::Priority::urgent : channel::Priority::usual;
  }
}

void write_empty_answer(Writer& writer, const Entry& request) {
  writer.entry(answer_header(request), 0, writer.position());
}

void write_error_answer(Writer& writer, const Entry& request, const Error& error) {
  const std::size_t end = writer.position();
  const std::uint32_t count = write_error(writer, error);
  writer.entry(answer_header(request, error.code()), count, end);
}

void write_capability_answer(Writer& writer, const Entry& request) {
  const std::size_t end = writer.position();
  const std::uint32_t level = 0;
  type_of<std::uint32_t>.write(writer, "return", &level);
  writer.entry(answer_header(request), 1, end);
}

}  // namespace rr::endpoint
