// SPDX-License-Identifier: Apache-2.0
// What members of served objects do when they are asked: they have the interpreter's thread call
// the object's function.
#include "rr/error.hpp"
#include "runtime/matlab/src/served.hpp"

namespace rr::matlab {
namespace {

using dynamic::List;
using dynamic::MemberDescription;
using dynamic::Value;

/// What answers for one member, for any thread; conversions are for the interpreter's.
struct ServedMember {
  std::shared_ptr<Answerer> answerer;
  std::shared_ptr<ServedTypes> types;
  MemberDescription member;

  [[nodiscard]] mxArray* write(const dynamic::ValueType& type, const Value& value) const {
    return to_mex(value, *types->plans.plan(type), types->plans);
  }
  [[nodiscard]] std::vector<mxArray*> request(const char* kind) const {
    return {make_text(kind), make_text(member.name)};
  }
  [[nodiscard]] std::vector<mxArray*> request(const char* kind, const List& arguments) const {
    std::vector<mxArray*> given = request(kind);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      given.push_back(write(member.parameters.at(i).type, arguments[i]));
    }
    return given;
  }
  [[nodiscard]] Value result(const mxArray* given, const char* of = ", result") const {
    return read_served(*types, given, member.type, "member " + member.name + of);
  }
};

// What the work throws is the answer.
void answer(const dynamic::Reply& reply, const std::function<Value()>& work) {
  try {
    reply(work());
  } catch (const Error&) {
    reply.fail(std::current_exception());
  } catch (const Misfit& misfit) {
    reply.fail(std::make_exception_ptr(misfit.error("")));
  }
}

void serve_property(const dynamic::ServedObject& object, const ServedMember& served) {
  object.on_get_later(served.member.name, [served](const dynamic::Reply& reply) {
    served.answerer->post([served, reply](Runtime&) {
      answer(reply,
             [&] { return served.result(served.answerer->call(served.request("get")), ""); });
    });
  });
  object.on_set_later(served.member.name,
                      [served](const Value& value, const dynamic::Reply& reply) {
                        served.answerer->post([served, value, reply](Runtime&) {
                          answer(reply, [&] {
                            std::vector<mxArray*> request = served.request("set");
                            request.push_back(served.write(served.member.type, value));
                            served.answerer->call(std::move(request));
                            return Value();
                          });
                        });
                      });
}

void serve_function(const dynamic::ServedObject& object, const ServedMember& served) {
  const char* const kind = served.member.type.kind() == dynamic::Kind::null ? "do" : "call";
  object.on_call_later(
      served.member.name, [served, kind](const List& arguments, const dynamic::Reply& reply) {
        served.answerer->post([served, kind, arguments, reply](Runtime&) {
          answer(reply, [&] {
            return served.result(served.answerer->call(served.request(kind, arguments)));
          });
        });
      });
}

// The function that the interpreter has given for a generator: `step(action, value)`, which gives
// a cell for each step, and nothing at the end.
dynamic::Steps make_steps(const ServedMember& served, std::shared_ptr<Answerer> generator) {
  const auto step = [served, generator](const Value& value) -> std::optional<Value> {
    return generator->ask<std::optional<Value>>([&](Runtime&) -> std::optional<Value> {
      const bool takes = served.member.generator != GeneratorForm::returns;
      mxArray* const given =
          takes ? served.write(served.member.generator_parameter, value) : make_null();
      const mxArray* const result = generator->call({make_text("next"), given});
      if (!mxIsCell(result)) return std::nullopt;
      if (served.member.generator == GeneratorForm::takes) return Value();
      return served.result(read_cells(result).at(0));
    });
  };
  const auto end = [generator](bool aborts) {
    generator->post([generator, aborts](Runtime&) {
      try {
        generator->call({make_text(aborts ? "abort" : "close"), make_null()});
      } catch (const Error&) {
        return;  // nobody is told: the client has gone on
      }
    });
  };
  return dynamic::Steps(step, end);
}

void serve_generator(const dynamic::ServedObject& object, const ServedMember& served) {
  object.on_generate(served.member.name, [served](const List& arguments) {
    const auto generator = served.answerer->ask<std::shared_ptr<Answerer>>([&](Runtime& runtime) {
      const mxArray* const step = served.answerer->call(served.request("generate", arguments));
      return std::make_shared<Answerer>(runtime, step);
    });
    return make_steps(served, generator);
  });
}

// The function gives `{number, object}`, or nothing; the object in it keeps the number.
void serve_objref(const dynamic::ServedObject& object, const ServedMember& served) {
  object.on_object(served.member.name, [served](const Value& index) {
    return served.answerer->ask<std::shared_ptr<Skeleton>>(
        [&](Runtime& runtime) -> std::shared_ptr<Skeleton> {
          std::vector<mxArray*> request = served.request("objref");
          request.push_back(make_text(served.member.object_type));
          if (!index.is_null()) request.push_back(plain_to_mex(index));
          const mxArray* const given = served.answerer->call(std::move(request));
          if (!mxIsCell(given)) return nullptr;
          const auto number = read_number<std::uint64_t>(read_cells(given).at(0));
          return runtime.handles().get<ServedHandle>(number)->object.skeleton();
        });
  });
}

}  // namespace

void serve_members(Runtime&, const ServedHandle& handle) {
  for (const MemberDescription& member : handle.object.members()) {
    const ServedMember served{handle.answerer, handle.types, member};
    if (member.kind == MemberKind::property) {
      serve_property(handle.object, served);
    } else if (member.kind == MemberKind::function && member.generator == GeneratorForm::none) {
      serve_function(handle.object, served);
    } else if (member.kind == MemberKind::function) {
      serve_generator(handle.object, served);
    } else if (member.kind == MemberKind::objref) {
      serve_objref(handle.object, served);
    }
  }
}

}  // namespace rr::matlab
