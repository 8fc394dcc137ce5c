// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/security.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/c/src/border.hpp"

namespace rr::capi {
namespace {

std::optional<bool> read_authorities(std::uint32_t given) {
  switch (given) {
    case RR_AUTHORITIES_UNLESS_GIVEN:
      return std::nullopt;
    case RR_AUTHORITIES_OF_SYSTEM:
      return true;
    case RR_AUTHORITIES_GIVEN:
      return false;
    default:
      refuse_argument("there are no such system_authorities");
  }
}

// Where events go. Copies are one.
struct Hearers {
  std::optional<AuditLog> file;
  std::shared_ptr<const Handler<rr_audit_options>> program;

  void operator()(const AuditEvent& event) const {
    if (file) (*file)(event);
    if (!program) return;
    std::string line = AuditLog::line(event);
    line.pop_back();
    (*program)->on_event((*program)->context, view(line));
  }
};

}  // namespace

TlsOptions read_tls(const rr_tls_options* given) {
  const rr_tls_options from = known(given);
  TlsOptions options;
  options.certificate_file = text(from.certificate_file);
  options.key_file = text(from.key_file);
  options.authority_files =
      read_texts(from.authority_files, from.authority_file_count, "there are no texts");
  options.revocation_files =
      read_texts(from.revocation_files, from.revocation_file_count, "there are no texts");
  if (from.pin_count != 0) need(from.pins, "there are no pins");
  for (std::size_t i = 0; i < from.pin_count; ++i) {
    options.pins.emplace(id_of(from.pins[i].node), text(from.pins[i].sha256));
  }
  options.is_required = from.is_required != 0;
  options.must_certify_clients = from.must_certify_clients != 0;
  options.trust_system_authorities = read_authorities(from.system_authorities);
  options.accepts_outdated_lists = from.accepts_outdated_lists != 0;
  if (from.look_again_period_ms != 0) {
    options.look_again_period =
        std::chrono::milliseconds(from.look_again_period_ms > 0 ? from.look_again_period_ms : 0);
  }
  return options;
}

AuditOptions read_audit(const rr_audit_options* given) {
  AuditOptions options;
  if (given == nullptr) return options;
  const auto program = std::make_shared<const Handler<rr_audit_options>>(given);
  const rr_audit_options& from = **program;
  options.requests = from.requests != 0;
  if (from.refusals != 0) options.refusals = from.refusals;
  Hearers hearers;
  if (from.file.size != 0) {
    AuditLog::Options log;
    if (from.max_size != 0) log.max_size = from.max_size;
    if (from.kept_files != 0) log.kept_files = from.kept_files;
    hearers.file.emplace(std::string(text(from.file)), log);
  }
  if (from.on_event != nullptr) hearers.program = program;
  if (hearers.file || hearers.program) options.on_event = std::move(hearers);
  return options;
}

std::shared_ptr<const Rights> read_rights(const rr_str* given) {
  return given != nullptr ? std::make_shared<const Rights>(text(*given)) : nullptr;
}

}  // namespace rr::capi
