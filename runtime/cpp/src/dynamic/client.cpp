// SPDX-License-Identifier: Apache-2.0

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "rr/varvalue.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/client/definition_reader.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {

/// The definitions of one session.
class DefinitionStore final : public client::DefinitionReader,
                              public std::enable_shared_from_this<DefinitionStore> {
 public:
  [[nodiscard]] std::shared_ptr<const TypeRegistry> types() const override {
    return {shared_from_this(), &types_};
  }
  // All are read again when there is another one: types of one reading know only each other. What
  // was found before is found before, too.
  void read(const std::map<std::string, std::string>& texts) override {
    const MutexLock lock(mutex_);
    if (texts.size() <= known_) return;
    std::vector<std::string> list;
    for (const auto& [name, text] : texts) list.push_back(text);
    auto tables = Tables::read(list, [] { return std::shared_ptr<Stub>(new DynamicStub); });
    (all_.empty() ? types_ : all_.back()->registry()).continue_in(tables->registry());
    all_.push_back(std::move(tables));
    known_ = texts.size();
  }
  [[nodiscard]] const Holding& holding() const override { return holding_of<Value>; }
  [[nodiscard]] std::string_view name_of_values() const override { return "rr::dynamic::Value"; }
  [[nodiscard]] Definitions newest() const {
    const MutexLock lock(mutex_);
    return all_.empty() ? Definitions() : Definitions(all_.back());
  }

 private:
  mutable Mutex mutex_;
  TypeRegistry types_;
  std::vector<std::shared_ptr<Tables>> all_ RR_GUARDED_BY(mutex_);
  std::size_t known_ RR_GUARDED_BY(mutex_) = 0;
};

namespace {

// By way of the bytes that both travel as.
void transfer(const rr::Type& from, const void* value, const rr::Type& to, void* result,
              const TypeRegistry* types) {
  Writer writer;
  writer.reset(MessageVersion::v4);
  from.write(writer, "value", value);
  if (writer.failed()) throw Error(writer.code(), writer.message());
  const std::vector<std::byte> bytes = writer.copy();
  Decoder decoder(MessageVersion::v4, nullptr, {}, types);
  ElementReader reader(decoder, bytes, 1);
  Element element;
  if (!reader.next(element) || !to.read(decoder, element, result)) {
    throw Error(decoder.code(), decoder.message());
  }
}

}  // namespace

VarValue to_varvalue(const Value& value) {
  const TypeRegistry types;
  const Value converted = any_node().convert(value, Place({}));
  VarValue result;
  transfer(any_node(), &converted, varvalue_type, &result, &types);
  return result;
}

Client::Client(rr::Client<Stub> client, std::shared_ptr<DefinitionStore> store)
    : ClientBase(std::move(static_cast<ClientBase&>(client))),  // the session, not the stub
      store_(std::move(store)),
      root_(std::dynamic_pointer_cast<DynamicStub>(client.stub())) {}

Definitions Client::types() const { return store_->newest(); }

Value Client::value(const VarValue& varvalue) const {
  Value result;
  transfer(varvalue_type, &varvalue, any_node(), &result, store_->types().get());
  return result;
}

StringMap Client::attributes() const {
  StringMap result;
  for (const auto& [name, attribute] : ClientBase::attributes()) {
    result.emplace(name, value(attribute));
  }
  return result;
}

StringMap Client::fetch_attributes() const {
  StringMap result;
  for (const auto& [name, attribute] : ClientBase::fetch_attributes()) {
    result.emplace(name, value(attribute));
  }
  return result;
}

Client connect(Node& node, std::string_view url, ConnectOptions options) {
  auto store = std::make_shared<DefinitionStore>();
  options.definition_reader = store;
  return {node.connect<Stub>(url, std::move(options)), std::move(store)};
}

void async_connect(Node& node, std::string url, ConnectOptions options, Done<Client> done) {
  auto store = std::make_shared<DefinitionStore>();
  options.definition_reader = store;
  node.connect_aside<Stub>(
      std::move(url), std::move(options),
      [store, done = std::move(done)](std::exception_ptr error, rr::Client<Stub> client) {
        done(error, error ? Client() : Client(std::move(client), store));
      });
}

namespace {

SubscriptionOptions reading_definitions(SubscriptionOptions options) {
  options.make_definition_reader = [] { return std::make_shared<DefinitionStore>(); };
  return options;
}

}  // namespace

ServiceSubscription subscribe(Node& node, std::string_view url, SubscriptionOptions options) {
  return node.subscribe(url, reading_definitions(std::move(options)));
}

ServiceSubscription subscribe(Node& node, std::vector<std::string> urls,
                              SubscriptionOptions options) {
  return node.subscribe(std::move(urls), reading_definitions(std::move(options)));
}

ServiceSubscription subscribe_types(Node& node, std::vector<std::string> types,
                                    SubscriptionOptions options) {
  return node.subscribe_types(std::move(types), reading_definitions(std::move(options)));
}

}  // namespace rr::dynamic
