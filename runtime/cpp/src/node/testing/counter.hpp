// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"

/// An object with the members that the tests of the network need, as the compiler would generate
/// it.
namespace rr::testing {

/// Where a counter stands.
struct Reading {
  double value = 0;
  std::string label;
  Array<std::uint8_t> picture;
  bool operator==(const Reading&) const = default;
};

/// `exception Overrun`
class Overrun : public Error {
 public:
  explicit Overrun(std::string message, std::string subname = {}, const VarValue& parameter = {})
      : Error(ErrorCode::remote_error, "test.counter.Overrun", std::move(message),
              std::move(subname), parameter) {}
  explicit Overrun(const Error& error) : Error(error) {}
};

extern const RecordType rr_Reading;
extern const Definition rr_definition;
extern const ObjectType rr_Counter;
extern const ObjectType rr_Named;

class NamedStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;
  std::string get_name();
};

class CounterStub : public virtual NamedStub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;

  double get_value();
  void set_value(double value);
  double get_fixed();
  void set_hidden(double hidden);
  double add(double a, double b);
  void reset();
  std::string echo(const std::string& text);
  std::optional<Reading> read(const std::string& label);
  Array<std::uint8_t> blob(std::uint32_t size);
  std::uint64_t take(const Array<double>& numbers);
  void raise(std::int32_t code, const std::string& text);
  void slow(std::int32_t milliseconds);
  void fire(std::int32_t count);
  VarValue any(const VarValue& value);
  Event<std::int32_t, std::string>& ticked() { return ticked_; }
  std::shared_ptr<CounterStub> get_child();
  std::shared_ptr<CounterStub> get_by_number(std::int32_t index);
  std::shared_ptr<CounterStub> get_by_name(const std::string& index);
  std::shared_ptr<Stub> get_anything();

  // The asynchronous forms, in async_counter.hpp.
  template <class Token>
  auto async_get_value(Token&& token);
  template <class Token>
  auto async_set_value(double value, Token&& token);
  template <class Token>
  auto async_add(double a, double b, Token&& token);
  template <class Token>
  auto async_add(double a, double b, const CallOptions& options, Token&& token);
  template <class Token>
  auto async_echo(const std::string& text, Token&& token);
  template <class Token>
  auto async_slow(std::int32_t milliseconds, Token&& token);
  template <class Token>
  auto async_slow(std::int32_t milliseconds, const CallOptions& options, Token&& token);
  template <class Token>
  auto async_raise(std::int32_t code, const std::string& text, Token&& token);
  template <class Token>
  auto async_get_by_name(const std::string& index, Token&& token);

 private:
  Event<std::int32_t, std::string> ticked_;

 public:
  CounterStub();
};

class CounterSkeleton : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;
  void rr_dispatch(std::size_t member, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) override;

  virtual std::string get_name() = 0;
  virtual double get_value() = 0;
  virtual void set_value(double value) = 0;
  virtual double get_fixed() = 0;
  virtual void set_hidden(double hidden) = 0;
  virtual double add(double a, double b) = 0;
  virtual void reset() = 0;
  virtual std::string echo(const std::string& text) = 0;
  virtual std::optional<Reading> read(const std::string& label) = 0;
  virtual Array<std::uint8_t> blob(std::uint32_t size) = 0;
  virtual std::uint64_t take(const Array<double>& numbers) = 0;
  virtual void raise(std::int32_t code, const std::string& text) = 0;
  virtual void slow(Reply<void> reply, std::int32_t milliseconds) = 0;
  virtual void fire(std::int32_t count) = 0;
  virtual VarValue any(const VarValue& value) = 0;
  virtual std::shared_ptr<Skeleton> get_child() = 0;
  virtual std::shared_ptr<Skeleton> get_by_number(std::int32_t index) = 0;
  virtual std::shared_ptr<Skeleton> get_by_name(const std::string& index) = 0;
  virtual std::shared_ptr<Skeleton> get_anything() = 0;

  void rr_fire_ticked(std::int32_t count, const std::string& text) const;
};

/// A counter that counts; what tests want otherwise they override.
class Counter : public CounterSkeleton {
 public:
  explicit Counter(std::string name = "root") : name_(std::move(name)) {}

  std::string get_name() override { return name_; }
  double get_value() override;
  void set_value(double value) override;
  double get_fixed() override { return 42.125; }
  void set_hidden(double hidden) override { set_value(hidden); }
  double add(double a, double b) override { return a + b; }
  void reset() override { set_value(0); }
  std::string echo(const std::string& text) override { return text; }
  std::optional<Reading> read(const std::string& label) override;
  Array<std::uint8_t> blob(std::uint32_t size) override;
  std::uint64_t take(const Array<double>& numbers) override { return numbers.size(); }
  void raise(std::int32_t code, const std::string& text) override;
  /// Sleeps in the handler.
  void slow(Reply<void> reply, std::int32_t milliseconds) override;
  void fire(std::int32_t count) override;
  VarValue any(const VarValue& value) override { return value; }
  std::shared_ptr<Skeleton> get_child() override;
  std::shared_ptr<Skeleton> get_by_number(std::int32_t index) override;
  std::shared_ptr<Skeleton> get_by_name(const std::string& index) override;
  std::shared_ptr<Skeleton> get_anything() override { return get_child(); }

 private:
  const std::string name_;
  std::mutex mutex_;
  double value_ = 0;
};

}  // namespace rr::testing

template <>
inline constexpr const rr::Type& rr::type_of<rr::testing::Reading> = rr::testing::rr_Reading;
