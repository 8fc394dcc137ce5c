// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/csharp/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

using namespace csharp;

template <>
const ViewType& view_type<ConstantView>() {
  static const ViewType type{
      view_field<&ConstantView::wire_name>("wire_name"), view_field<&ConstantView::name>("name"),
      view_field<&ConstantView::doc>("doc"), view_field<&ConstantView::definition>("definition")};
  return type;
}

template <>
const ViewType& view_type<EnumValueView>() {
  static const ViewType type{
      view_field<&EnumValueView::wire_name>("wire_name"), view_field<&EnumValueView::name>("name"),
      view_field<&EnumValueView::value>("value"), view_field<&EnumValueView::doc>("doc")};
  return type;
}

template <>
const ViewType& view_type<EnumView>() {
  static const ViewType type{view_field<&EnumView::wire_name>("wire_name"),
                             view_field<&EnumView::name>("name"), view_field<&EnumView::doc>("doc"),
                             view_field<&EnumView::values>("values")};
  return type;
}

template <>
const ViewType& view_type<ExceptionView>() {
  static const ViewType type{view_field<&ExceptionView::wire_name>("wire_name"),
                             view_field<&ExceptionView::name>("name"),
                             view_field<&ExceptionView::doc>("doc")};
  return type;
}

template <>
const ViewType& view_type<FieldView>() {
  static const ViewType type{view_field<&FieldView::wire_name>("wire_name"),
                             view_field<&FieldView::name>("name"),
                             view_field<&FieldView::doc>("doc"),
                             view_field<&FieldView::type>("type"),
                             view_field<&FieldView::initial>("initial"),
                             view_field<&FieldView::codec>("codec"),
                             view_field<&FieldView::robdef_type>("robdef_type"),
                             view_field<&FieldView::items>("items"),
                             view_field<&FieldView::item_type>("item_type"),
                             view_field<&FieldView::item_count>("item_count")};
  return type;
}

template <>
const ViewType& view_type<RecordView>() {
  static const ViewType type{view_field<&RecordView::wire_name>("wire_name"),
                             view_field<&RecordView::name>("name"),
                             view_field<&RecordView::doc>("doc"),
                             view_field<&RecordView::is_struct>("is_struct"),
                             view_field<&RecordView::is_pod>("is_pod"),
                             view_field<&RecordView::is_namedarray>("is_namedarray"),
                             view_field<&RecordView::number_type>("number_type"),
                             view_field<&RecordView::number_codec>("number_codec"),
                             view_field<&RecordView::packed_size>("packed_size"),
                             view_field<&RecordView::constants>("constants"),
                             view_field<&RecordView::fields>("fields"),
                             view_field<&RecordView::writes>("writes"),
                             view_field<&RecordView::has_fields>("has_fields"),
                             view_field<&RecordView::has_rows>("has_rows"),
                             view_field<&RecordView::field_count>("field_count"),
                             view_field<&RecordView::codec_class>("codec_class")};
  return type;
}

template <>
const ViewType& view_type<ParameterView>() {
  static const ViewType type{
      view_field<&ParameterView::wire_name>("wire_name"), view_field<&ParameterView::name>("name"),
      view_field<&ParameterView::type>("type"), view_field<&ParameterView::codec>("codec"),
      view_field<&ParameterView::robdef_type>("robdef_type")};
  return type;
}

template <>
const ViewType& view_type<MemberView>() {
  static const ViewType type{view_field<&MemberView::wire_name>("wire_name"),
                             view_field<&MemberView::name>("name"),
                             view_field<&MemberView::doc>("doc"),
                             view_field<&MemberView::kind>("kind"),
                             view_field<&MemberView::is_property>("is_property"),
                             view_field<&MemberView::is_function>("is_function"),
                             view_field<&MemberView::is_event>("is_event"),
                             view_field<&MemberView::is_objref>("is_objref"),
                             view_field<&MemberView::is_pipe>("is_pipe"),
                             view_field<&MemberView::is_callback>("is_callback"),
                             view_field<&MemberView::is_wire>("is_wire"),
                             view_field<&MemberView::is_memory>("is_memory"),
                             view_field<&MemberView::is_served>("is_served"),
                             view_field<&MemberView::is_inherited>("is_inherited"),
                             view_field<&MemberView::is_hiding>("is_hiding"),
                             view_field<&MemberView::number>("number"),
                             view_field<&MemberView::row>("row"),
                             view_field<&MemberView::access>("access"),
                             view_field<&MemberView::is_perclient>("is_perclient"),
                             view_field<&MemberView::is_urgent>("is_urgent"),
                             view_field<&MemberView::can_get>("can_get"),
                             view_field<&MemberView::can_set>("can_set"),
                             view_field<&MemberView::type>("type"),
                             view_field<&MemberView::codec>("codec"),
                             view_field<&MemberView::initial>("initial"),
                             view_field<&MemberView::robdef_type>("robdef_type"),
                             view_field<&MemberView::item>("item"),
                             view_field<&MemberView::item_codec>("item_codec"),
                             view_field<&MemberView::is_multi>("is_multi"),
                             view_field<&MemberView::has_result>("has_result"),
                             view_field<&MemberView::parameters>("parameters"),
                             view_field<&MemberView::writes>("writes"),
                             view_field<&MemberView::has_parameters>("has_parameters"),
                             view_field<&MemberView::signature>("signature"),
                             view_field<&MemberView::signature_before>("signature_before"),
                             view_field<&MemberView::arguments>("arguments"),
                             view_field<&MemberView::arguments_before>("arguments_before"),
                             view_field<&MemberView::cancel>("cancel"),
                             view_field<&MemberView::client>("client"),
                             view_field<&MemberView::urgent>("urgent"),
                             view_field<&MemberView::handler>("handler"),
                             view_field<&MemberView::task>("task"),
                             view_field<&MemberView::result>("result"),
                             view_field<&MemberView::served>("served"),
                             view_field<&MemberView::served_signature>("served_signature"),
                             view_field<&MemberView::invocation>("invocation"),
                             view_field<&MemberView::verb>("verb"),
                             view_field<&MemberView::codecs>("codecs"),
                             view_field<&MemberView::answer>("answer"),
                             view_field<&MemberView::is_generator>("is_generator"),
                             view_field<&MemberView::is_source>("is_source"),
                             view_field<&MemberView::is_sink>("is_sink"),
                             view_field<&MemberView::is_filter>("is_filter"),
                             view_field<&MemberView::generator_parameter>("generator_parameter"),
                             view_field<&MemberView::interface>("interface"),
                             view_field<&MemberView::stub>("stub"),
                             view_field<&MemberView::object_type>("object_type"),
                             view_field<&MemberView::is_varobject>("is_varobject"),
                             view_field<&MemberView::has_int32_index>("has_int32_index"),
                             view_field<&MemberView::has_string_index>("has_string_index"),
                             view_field<&MemberView::index_parameter>("index_parameter"),
                             view_field<&MemberView::index_argument>("index_argument"),
                             view_field<&MemberView::index_type>("index_type"),
                             view_field<&MemberView::index_read>("index_read"),
                             view_field<&MemberView::handle>("handle"),
                             view_field<&MemberView::handle_served>("handle_served"),
                             view_field<&MemberView::first>("first")};
  return type;
}

template <>
const ViewType& view_type<ObjectView>() {
  static const ViewType type{view_field<&ObjectView::wire_name>("wire_name"),
                             view_field<&ObjectView::short_name>("short_name"),
                             view_field<&ObjectView::doc>("doc"),
                             view_field<&ObjectView::interface>("interface"),
                             view_field<&ObjectView::bases>("bases"),
                             view_field<&ObjectView::stub>("stub"),
                             view_field<&ObjectView::skeleton>("skeleton"),
                             view_field<&ObjectView::default_class>("default_class"),
                             view_field<&ObjectView::has_default>("has_default"),
                             view_field<&ObjectView::constants>("constants"),
                             view_field<&ObjectView::members>("members"),
                             view_field<&ObjectView::has_requests>("has_requests"),
                             view_field<&ObjectView::has_memories>("has_memories")};
  return type;
}

template <>
const ViewType& view_type<DeclarationView>() {
  static const ViewType type{view_field<&DeclarationView::exception>("exception"),
                             view_field<&DeclarationView::enumeration>("enumeration"),
                             view_field<&DeclarationView::record>("record"),
                             view_field<&DeclarationView::object>("object")};
  return type;
}

template <>
const ViewType& view_type<LibraryView>() {
  static const ViewType type{view_field<&LibraryView::task>("task"),
                             view_field<&LibraryView::value_task>("value_task"),
                             view_field<&LibraryView::token>("token"),
                             view_field<&LibraryView::async_enumerable>("async_enumerable"),
                             view_field<&LibraryView::stub>("stub"),
                             view_field<&LibraryView::stub_type>("stub_type"),
                             view_field<&LibraryView::object_handle>("object_handle"),
                             view_field<&LibraryView::skeleton>("skeleton"),
                             view_field<&LibraryView::call>("call"),
                             view_field<&LibraryView::request>("request"),
                             view_field<&LibraryView::served_type>("served_type"),
                             view_field<&LibraryView::served_member>("served_member"),
                             view_field<&LibraryView::served_memory>("served_memory"),
                             view_field<&LibraryView::stored>("stored"),
                             view_field<&LibraryView::stored_per_client>("stored_per_client"),
                             view_field<&LibraryView::stored_memory>("stored_memory"),
                             view_field<&LibraryView::not_implemented>("not_implemented")};
  return type;
}

template <>
const ViewType& view_type<CodecView>() {
  static const ViewType type{view_field<&CodecView::name>("name"),
                             view_field<&CodecView::type>("type"),
                             view_field<&CodecView::value>("value")};
  return type;
}

template <>
const ViewType& view_type<DefinitionView>() {
  static const ViewType type{view_field<&DefinitionView::wire_name>("wire_name"),
                             view_field<&DefinitionView::space>("space"),
                             view_field<&DefinitionView::doc>("doc"),
                             view_field<&DefinitionView::usings>("usings"),
                             view_field<&DefinitionView::library>("library"),
                             view_field<&DefinitionView::value_codec>("value_codec"),
                             view_field<&DefinitionView::struct_codec>("struct_codec"),
                             view_field<&DefinitionView::pod_codec>("pod_codec"),
                             view_field<&DefinitionView::namedarray_codec>("namedarray_codec"),
                             view_field<&DefinitionView::element_writer>("element_writer"),
                             view_field<&DefinitionView::field_reader>("field_reader"),
                             view_field<&DefinitionView::error>("error"),
                             view_field<&DefinitionView::error_code>("error_code"),
                             view_field<&DefinitionView::varvalue>("varvalue"),
                             view_field<&DefinitionView::service_definition>("service_definition"),
                             view_field<&DefinitionView::exception_type>("exception_type"),
                             view_field<&DefinitionView::stub_api>("stub_api"),
                             view_field<&DefinitionView::has_objects>("has_objects"),
                             view_field<&DefinitionView::imports>("imports"),
                             view_field<&DefinitionView::constants>("constants"),
                             view_field<&DefinitionView::has_constants>("has_constants"),
                             view_field<&DefinitionView::declarations>("declarations"),
                             view_field<&DefinitionView::codecs>("codecs"),
                             view_field<&DefinitionView::has_codecs>("has_codecs"),
                             view_field<&DefinitionView::has_fields>("has_fields"),
                             view_field<&DefinitionView::text>("text")};
  return type;
}

template <>
const ViewType& view_type<ModelView>() {
  static const ViewType type{view_field<&ModelView::definitions>("definitions")};
  return type;
}

}  // namespace robdef
