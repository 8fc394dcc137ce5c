// SPDX-License-Identifier: Apache-2.0
// Model -> view: what is declared, in which order, with which libraries. Members are made in
// member_view.cpp. Reports R0901 to R0904.
#include "compiler/backends/csharp/view.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include "compiler/backends/check_values.hpp"
#include "compiler/backends/csharp/constants.hpp"
#include "compiler/backends/csharp/view_parts.hpp"
#include "compiler/backends/literals.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::csharp {

std::vector<std::string> summary(const std::string& documentation, std::size_t indent) {
  if (documentation.empty()) return {};
  std::string text = replace_all(documentation, "&", "&amp;");
  text = replace_all(replace_all(text, "<", "&lt;"), ">", "&gt;");
  std::vector<std::string> lines = prose(text, "/// ", line_width - indent - 20);
  if (lines.size() == 1) return {"/// <summary>" + lines.front().substr(4) + "</summary>"};
  lines.insert(lines.begin(), "/// <summary>");
  lines.emplace_back("/// </summary>");
  return lines;
}

std::vector<ConstantView> make_constants(const std::vector<model::Constant>& constants,
                                         const std::string& owner, const Context& context,
                                         std::size_t indent) {
  std::vector<ConstantView> views;
  for (const model::Constant& constant : constants) {
    ConstantView view;
    view.wire_name = constant.name;
    view.name = member_name(code_name(constant), owner, constant.span, context.report);
    view.doc = summary(constant.documentation, indent);
    view.definition =
        constant_definition(constant, view.name, context.types, context.names, indent);
    views.push_back(std::move(view));
  }
  return views;
}

void check_types(const model::Definition& definition, Report& report) {
  const auto judge = [](const model::Type& type) -> std::string {
    const bool is_any =
        type.array == model::ArrayForm::any_length || type.array == model::ArrayForm::any_shape;
    constexpr std::uint64_t most = 0x7FFFFFC7;
    if (!is_any && type.element_count() > most) return "an array of more than 2147483591 items";
    for (const std::uint32_t dimension : type.dimensions) {
      if (dimension > most) return "a dimension of more than 2147483591";
    }
    return "";
  };
  check_values(definition, {.language = "C#", .judge = judge}, report);
  // Action and Func take no more.
  constexpr std::size_t most_parameters = 15;
  for (const model::Object& object : definition.objects) {
    for (const model::Member& member : object.members) {
      const bool is_delegate =
          member.kind == model::MemberKind::event || member.kind == model::MemberKind::callback;
      if (!is_delegate || member.parameters.size() <= most_parameters) continue;
      report.add(Code::R0902, member.span,
                 "a delegate of more than 15 parameters cannot be expressed in C#");
    }
  }
}

namespace {

EnumView make_enum(const model::Enum& enumeration, Report& report) {
  EnumView view;
  view.wire_name = enumeration.name;
  view.name = pascal(code_name(enumeration));
  view.doc = summary(enumeration.documentation, 0);
  NameSet names(csharp_language, report);
  for (const model::EnumValue& value : enumeration.values) {
    const std::string name = pascal(code_name(value));
    names.add(name, value.span, "value",
              enumeration.definition->name + "." + enumeration.name + "." + value.name);
    view.values.push_back({.wire_name = value.name,
                           .name = name,
                           .value = enum_literal(value),
                           .doc = summary(value.documentation, 4)});
  }
  return view;
}

ExceptionView make_exception(const model::Exception& exception) {
  return {.wire_name = exception.definition->name + "." + exception.name,
          .name = pascal(code_name(exception)),
          .doc = summary(exception.documentation, 0)};
}

FieldView make_field(const model::Field& field, const model::Record& record,
                     const std::string& owner, const Context& context) {
  const Place place = record.kind == model::RecordKind::pod          ? Place::in_pod
                      : record.kind == model::RecordKind::namedarray ? Place::in_namedarray
                                                                     : Place::anywhere;
  FieldView view;
  view.wire_name = field.name;
  view.name = member_name(code_name(field), owner, field.span, context.report);
  view.doc = summary(field.documentation, 4);
  view.robdef_type = field.type.text();
  if (place == Place::in_namedarray && field.type.array != model::ArrayForm::none) {
    view.items = view.type = "Rr" + view.name + "Items";
    view.item_type = context.types.item(field.type).text;
    view.item_count = std::to_string(field.type.element_count());
    return view;
  }
  CsType type = context.types.spell(field.type, place);
  view.type = std::move(type.text);
  view.initial = std::move(type.initial);
  view.codec = std::move(type.codec);
  return view;
}

RecordView make_record(const model::Record& record, const Context& context) {
  RecordView view;
  describe(view, record);
  view.name = pascal(code_name(record));
  view.doc = summary(record.documentation, 0);
  if (view.is_namedarray) {
    view.number_type = context.types.number(record.number);
    view.number_codec = context.types.number_codec(record.number);
  }
  view.packed_size = std::to_string(record.packed_size);
  view.constants = make_constants(record.constants, view.name, context, 4);
  NameSet names(csharp_language, context.report);
  const std::string path = record.qualified_name() + ".";
  for (std::size_t i = 0; i < view.constants.size(); ++i) {
    const model::Constant& constant = record.constants[i];
    names.add(view.constants[i].name, constant.span, "constant", path + constant.name);
  }
  for (const model::Field& field : record.fields) {
    view.fields.push_back(make_field(field, record, view.name, context));
    names.add(view.fields.back().name, field.span, "field", path + field.name);
    view.has_rows |= !view.fields.back().items.empty();
  }
  view.writes.assign(view.fields.rbegin(), view.fields.rend());
  view.field_count = std::to_string(view.fields.size());
  view.codec_class = "Rr" + view.name + "Codec";
  return view;
}

class DefinitionMaker {
 public:
  DefinitionMaker(const model::Definition& definition, const model::Model& model, Report& report)
      : definition_(definition),
        names_(definition, model, report),
        types_(names_),
        context_{names_, types_, report} {}

  DefinitionView make() {
    view_.wire_name = definition_.name;
    view_.space = namespace_of(definition_.name);
    view_.doc = summary(definition_.documentation, 0);
    make_library();
    for (const model::Definition* import : definition_.imports) {
      view_.imports.push_back(qualified(*import, "RrDefinition.Value"));
    }
    view_.constants =
        make_constants(definition_.constants, std::string(constants_class), context_, 4);
    check_constants();
    view_.has_constants = !view_.constants.empty();
    for (const model::Declaration& declaration : definition_.declarations) {
      std::visit([&](const auto* declared) { make(*declared); }, declaration);
    }
    for (const CodecField& field : types_.codecs()) {
      view_.codecs.push_back({.name = field.name, .type = field.type, .value = field.value});
    }
    view_.has_codecs = !view_.codecs.empty();
    view_.text = unicode_literal_lines(definition_.text);
    std::set<std::string> usings = names_.usings();
    usings.emplace(runtime_space);
    // System first, as the formatter wants it.
    const auto is_system = [](const std::string& space) { return space.starts_with("System"); };
    std::ranges::copy_if(usings, std::back_inserter(view_.usings), is_system);
    std::ranges::remove_copy_if(usings, std::back_inserter(view_.usings), is_system);
    return std::move(view_);
  }

 private:
  /// The templates name these.
  void make_library() {
    const auto runtime = [&](const char* name) { return names_.library(runtime_space, name); };
    view_.value_codec = runtime("ValueCodec");
    view_.struct_codec = runtime("StructCodec");
    view_.pod_codec = runtime("PodCodec");
    view_.namedarray_codec = runtime("NamedArrayCodec");
    view_.element_writer = runtime("ElementWriter");
    view_.field_reader = runtime("FieldReader");
    view_.error = runtime("RobdefException");
    view_.error_code = runtime("ErrorCode");
    view_.varvalue = runtime("VarValue");
    view_.service_definition = runtime("ServiceDefinition");
    view_.exception_type = runtime("ExceptionType");
    view_.stub_api = runtime("StubApi");
    view_.has_objects = !definition_.objects.empty();
    if (!view_.has_objects) return;
    LibraryView& library = view_.library;
    library.task = names_.library("System.Threading.Tasks", "Task");
    library.value_task = names_.library("System.Threading.Tasks", "ValueTask");
    library.token = names_.library("System.Threading", "CancellationToken");
    library.async_enumerable = names_.library("System.Collections.Generic", "IAsyncEnumerable");
    library.stub = runtime("Stub");
    library.stub_type = runtime("IStub");
    library.object_handle = runtime("ObjectHandle");
    library.skeleton = runtime("Skeleton");
    library.call = runtime("Call");
    library.request = runtime("ServedRequest");
    library.served_type = runtime("ServedType");
    library.served_member = runtime("ServedMember");
    library.served_memory = runtime("ServedMemory");
    library.stored = runtime("Stored");
    library.stored_per_client = runtime("StoredPerClient");
    library.stored_memory = runtime("StoredMemory");
    library.not_implemented = runtime("NotServed");
  }

  void check_constants() {
    NameSet names(csharp_language, context_.report);
    for (std::size_t i = 0; i < view_.constants.size(); ++i) {
      const model::Constant& constant = definition_.constants[i];
      names.add(view_.constants[i].name, constant.span, "constant",
                definition_.name + "." + constant.name);
    }
  }

  void make(const model::Constant& /*constant*/) {}
  void make(const model::Exception& exception) {
    view_.declarations.emplace_back().exception = make_exception(exception);
  }
  void make(const model::Enum& enumeration) {
    view_.declarations.emplace_back().enumeration = make_enum(enumeration, context_.report);
  }
  void make(const model::Record& record) {
    view_.declarations.emplace_back().record = make_record(record, context_);
    if (record.kind != model::RecordKind::namedarray) view_.has_fields |= !record.fields.empty();
    if (record.kind == model::RecordKind::namedarray) {
      names_.library("System.Runtime.InteropServices", "StructLayout");
      if (view_.declarations.back().record->has_rows) {
        names_.library("System.Runtime.CompilerServices", "InlineArray");
      }
    }
  }
  void make(const model::Object& object) {
    view_.declarations.emplace_back().object = make_object(object, context_);
  }

  const model::Definition& definition_;
  Names names_;
  Types types_;
  Context context_;
  DefinitionView view_;
};

}  // namespace

ModelView make_view(const model::Model& model, Report& report) {
  ModelView view;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    check_types(*definition, report);
    view.definitions.push_back(DefinitionMaker(*definition, model, report).make());
  }
  return view;
}

}  // namespace robdef::csharp
