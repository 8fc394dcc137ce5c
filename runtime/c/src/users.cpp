// SPDX-License-Identifier: Apache-2.0
// Who may use services.
#include "runtime/c/src/users.hpp"

#include <utility>

#include "rr/type.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/request.hpp"

namespace rr::capi {
namespace {

// Users whom the program recognises.
class RawUsers final : public Users {
 public:
  explicit RawUsers(std::shared_ptr<const Handler<rr_users_handler>> handler)
      : handler_(std::move(handler)) {}

  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& credentials,
                                  const NodeId& node) const override {
    const auto wait = std::make_shared<Wait<User>>();
    auto asked = std::make_unique<UserRequest>(wait);
    asked->set_arguments(write_data(type_of<VarStringMap>, &credentials, "credentials"));
    asked->set_name(name);
    asked->info.node = id_of(node);
    describe_client(asked->info);
    rr_request_info info = asked->info;
    info.size = sizeof info;
    (*handler_)->on_authenticate((*handler_)->context, asked.release(), &info);
    return wait->take();
  }

 private:
  const std::shared_ptr<const Handler<rr_users_handler>> handler_;
};

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::output;
using rr::capi::text;

extern "C" {

rr_status rr_users_from_text(rr_str given, rr_users** out_users, rr_error** error) {
  return guarded(error, [&] {
    output(out_users) = nullptr;
    *out_users = new rr_users{std::make_shared<const rr::PasswordUsers>(text(given))};
  });
}

rr_status rr_users_from_file(rr_str path, rr_users** out_users, rr_error** error) {
  return guarded(error, [&] {
    output(out_users) = nullptr;
    *out_users = new rr_users{rr::PasswordUsers::from_file(std::string(text(path)))};
  });
}

rr_status rr_users_new(const rr_users_handler* handler, rr_users** out_users, rr_error** error) {
  return guarded(error, [&] {
    output(out_users) = nullptr;
    *out_users = new rr_users{std::make_shared<const rr::capi::RawUsers>(
        rr::capi::take_handler(handler, &rr_users_handler::on_authenticate))};
  });
}

void rr_users_release(rr_users* users) { rr::capi::release(users); }

rr_status rr_password_hash(rr_str password, rr_data** out_data, rr_error** error) {
  return guarded(error, [&] {
    output(out_data) = nullptr;
    *out_data = rr::capi::Data::text(rr::PasswordUsers::hash(text(password))).hand_out();
  });
}

}  // extern "C"
