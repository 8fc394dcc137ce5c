// SPDX-License-Identifier: Apache-2.0
#include "gateway/kept_stream.hpp"

#include <array>
#include <charconv>
#include <ctime>
#include <nlohmann/json.hpp>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using StreamJson = nlohmann::json;

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = result.ec == std::errc() && result.ptr == text.data() + text.size();
  return is_whole ? std::optional(number) : std::nullopt;
}

std::uint64_t count_in(const StreamJson& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

std::string string_in(const StreamJson& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Of `2026-11-27T11:44:16.123456789Z`; the end of the text is of no importance.
std::chrono::nanoseconds stream_time(const std::string& text) {
  std::tm parts{};
  const char* const rest = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
  if (rest == nullptr) return std::chrono::nanoseconds(0);
  std::int64_t fraction = 0;
  std::int64_t unit = 1'000'000'000;
  if (*rest == '.') {
    for (const char* at = rest + 1; *at >= '0' && *at <= '9' && unit > 1; ++at) {
      unit /= 10;
      fraction += (*at - '0') * unit;
    }
  }
  return std::chrono::seconds(::timegm(&parts)) + std::chrono::nanoseconds(fraction);
}

}  // namespace

std::string stream_create_subject() { return "$JS.API.STREAM.CREATE." + std::string(kept_stream); }

std::string stream_create_text(int replicas) {
  return StreamJson{
      {"name", kept_stream},      {"subjects", {"rrkept.>"}},
      {"retention", "limits"},    {"storage", "file"},
      {"discard", "old"},         {"max_msgs_per_subject", 1},
      {"max_msgs", -1},           {"max_bytes", -1},
      {"max_consumers", -1},      {"max_age", 0},
      {"num_replicas", replicas}, {"republish", {{"src", "rrkept.>"}, {"dest", "rr.>"}}}}
      .dump();
}

std::string reader_create_subject(std::string_view name, std::string_view kept_filter) {
  return "$JS.API.CONSUMER.CREATE." + std::string(kept_stream) + "." + std::string(name) + "." +
         std::string(kept_filter);
}

std::string reader_create_text(std::string_view name, std::string_view kept_filter,
                               std::string_view inbox) {
  return StreamJson{{"stream_name", kept_stream},
                    {"config",
                     {{"name", name},
                      {"deliver_policy", "last_per_subject"},
                      {"deliver_subject", inbox},
                      {"filter_subject", kept_filter},
                      {"ack_policy", "none"},
                      {"replay_policy", "instant"},
                      {"mem_storage", true},
                      {"num_replicas", 1}}}}
      .dump(-1, ' ', false, StreamJson::error_handler_t::replace);
}

std::optional<StreamAnswer> read_answer(const Bytes& payload) {
  const StreamJson json = StreamJson::parse(text_of(payload), nullptr, false);
  if (!json.is_object()) return std::nullopt;
  StreamAnswer answer;
  const auto error = json.find("error");
  if (error != json.end() && error->is_object()) {
    answer.code = static_cast<int>(count_in(*error, "err_code"));
    if (answer.code == 0) answer.code = -1;
    answer.description = string_in(*error, "description");
    return answer;
  }
  answer.pending = count_in(json, "num_pending");
  answer.created = stream_time(string_in(json, "created"));
  return answer;
}

// $JS.ACK.<stream>.<reader>.<times>.<number>.<number of reader>.<nanoseconds>.<pending>
std::optional<KeptPlace> kept_place(std::string_view reply) {
  constexpr std::size_t count = 9;
  std::array<std::string_view, count> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end = reply.find('.');
    if ((end == std::string_view::npos) != (i + 1 == count)) return std::nullopt;
    parts[i] = reply.substr(0, end);
    if (end != std::string_view::npos) reply.remove_prefix(end + 1);
  }
  if (parts[0] != "$JS" || parts[1] != "ACK" || parts[2] != kept_stream) return std::nullopt;
  const auto number = whole_number(parts[5]);
  const auto time = whole_number(parts[7]);
  if (!number || !time) return std::nullopt;
  return KeptPlace{std::string(parts[3]), *number, std::chrono::nanoseconds(*time)};
}

}  // namespace rr::gateway
