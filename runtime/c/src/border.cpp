// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/border.hpp"

#include <new>

#include "rr/codec.hpp"
#include "rr/varvalue.hpp"
#include "runtime/c/src/elements.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"

namespace rr::capi {
namespace {

// What an exception says, to the program or to the other side.
Error described(const std::exception_ptr& why) {
  try {
    std::rethrow_exception(why);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_system_resource, "there is not enough memory"};
  } catch (const Error&) {
    return endpoint::describe(why);
  } catch (const std::exception& error) {
    return {ErrorCode::internal_error, error.what()};
  } catch (...) {
    return {ErrorCode::internal_error, "an unknown failure"};
  }
}

}  // namespace

rr_error* make_error(const std::exception_ptr& why) noexcept {
  try {
    return new rr_error{ErrorInfo(described(why))};
  } catch (...) {
    return nullptr;
  }
}

rr_status status_of(const std::exception_ptr& why) noexcept {
  try {
    return static_cast<rr_status>(described(why).code());
  } catch (...) {
    return RR_OUT_OF_SYSTEM_RESOURCE;
  }
}

rr_status tell(rr_error** error, const std::exception_ptr& why) noexcept {
  rr_error* const made = make_error(why);
  if (made == nullptr) return RR_OUT_OF_SYSTEM_RESOURCE;
  const rr_status status = made->content.info().code;
  if (error != nullptr) {
    *error = made;
  } else {
    delete made;
  }
  return status;
}

void refuse_argument(const char* what) { throw Error(ErrorCode::invalid_argument, what); }

std::string_view text(rr_str given) {
  if (given.size == 0) return {};
  return {&need(given.data, "a text is NULL"), given.size};
}

std::vector<std::string> read_texts(const rr_str* texts, std::size_t count, const char* none) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < count; ++i) result.emplace_back(text((&need(texts, none))[i]));
  return result;
}

std::vector<rr_str> view_all(const std::vector<std::string>& texts) {
  std::vector<rr_str> result;
  for (const std::string& each : texts) result.push_back(view(each));
  return result;
}

rr_str view(std::string_view given) { return {given.data(), given.size()}; }

rr_node_id id_of(const NodeId& id) {
  rr_node_id result;
  std::memcpy(result.bytes, id.bytes.data(), sizeof result.bytes);
  return result;
}

NodeId id_of(const rr_node_id& id) {
  NodeId result;
  std::memcpy(result.bytes.data(), id.bytes, sizeof id.bytes);
  return result;
}

rr_time time_of(const TimeSpec& time) { return {time.seconds, time.nanoseconds, 0}; }

std::chrono::milliseconds duration(std::int32_t milliseconds) {
  return milliseconds < 0 ? std::chrono::milliseconds::max()
                          : std::chrono::milliseconds(milliseconds);
}

std::chrono::milliseconds patience(std::int32_t milliseconds) { return duration(milliseconds); }

Terms::Terms(const rr_call_options* options)
    : options_(known(options)),
      call_options_{duration(options_.timeout_ms),
                    options_.cancellation != nullptr
                        ? options_.cancellation->cancellation.get_token()
                        : std::stop_token()},
      scope_(call_options_) {}

Error read_info(const rr_error_info* given) {
  const rr_error_info info = known(given, true);
  auto code = static_cast<ErrorCode>(info.code);
  if (info.code <= 0 || info.code > 0xFFFF) code = ErrorCode::unknown_error;
  std::string name(text(info.name));
  if (name.empty()) name = error_name(code);
  VarValue parameter;
  if (info.parameter.count != 0) {
    const Values values(&info.parameter);
    decode_value(values.bytes(), type_of<VarValue>, &parameter, values.version(), nullptr, {});
  }
  return {code, std::move(name), std::string(text(info.message)), std::string(text(info.subname)),
          parameter};
}

ErrorInfo::ErrorInfo(const Error& error) : error_(error) {
  info_.size = sizeof info_;
  info_.code = static_cast<rr_status>(error_.code());
  info_.name = view(error_.name());
  info_.subname = view(error_.subname());
  info_.message = view(error_.message());
  if (error_.parameter().is_null()) return;
  parameter_ = encode(error_.parameter(), MessageVersion::v4, "errorparam");
  info_.parameter = {reinterpret_cast<const std::uint8_t*>(parameter_.data()), parameter_.size(), 1,
                     4};
}

}  // namespace rr::capi

using rr::capi::guarded;

extern "C" {

uint32_t rr_abi_version(void) { return RR_ABI_VERSION; }

void rr_error_read(const rr_error* error, rr_error_info* info) {
  if (error != nullptr && info != nullptr) rr::capi::fill(info, error->content.info());
}

void rr_error_release(rr_error* error) { rr::capi::release(error); }

rr_status rr_cancellation_new(rr_cancellation** out_cancellation, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_cancellation) = nullptr;
    *out_cancellation = new rr_cancellation{};
  });
}

void rr_cancellation_cancel(rr_cancellation* cancellation) {
  rr::capi::guarded_or(0, [&] {
    if (cancellation != nullptr) cancellation->cancellation.request_stop();
    return 0;
  });
}

void rr_cancellation_release(rr_cancellation* cancellation) { rr::capi::release(cancellation); }

}  // extern "C"
