// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/cpp/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

using namespace cpp;

template <>
const ViewType& view_type<ConstantView>() {
  static const ViewType type{view_field<&ConstantView::wire_name>("wire_name"),
                             view_field<&ConstantView::name>("name"),
                             view_field<&ConstantView::doc>("doc"),
                             view_field<&ConstantView::is_struct>("is_struct"),
                             view_field<&ConstantView::type>("type"),
                             view_field<&ConstantView::value>("value"),
                             view_field<&ConstantView::definition>("definition")};
  return type;
}

template <>
const ViewType& view_type<AliasView>() {
  static const ViewType type{view_field<&AliasView::definition>("definition")};
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
  static const ViewType type{
      view_field<&EnumView::wire_name>("wire_name"),   view_field<&EnumView::name>("name"),
      view_field<&EnumView::qualified>("qualified"),   view_field<&EnumView::doc>("doc"),
      view_field<&EnumView::has_values>("has_values"), view_field<&EnumView::values>("values")};
  return type;
}

template <>
const ViewType& view_type<ExceptionView>() {
  static const ViewType type{view_field<&ExceptionView::wire_name>("wire_name"),
                             view_field<&ExceptionView::name>("name"),
                             view_field<&ExceptionView::qualified>("qualified"),
                             view_field<&ExceptionView::doc>("doc"),
                             view_field<&ExceptionView::constructor>("constructor"),
                             view_field<&ExceptionView::parameter>("parameter"),
                             view_field<&ExceptionView::error>("error")};
  return type;
}

template <>
const ViewType& view_type<FieldView>() {
  static const ViewType type{view_field<&FieldView::wire_name>("wire_name"),
                             view_field<&FieldView::name>("name"),
                             view_field<&FieldView::doc>("doc"),
                             view_field<&FieldView::type>("type"),
                             view_field<&FieldView::descriptor>("descriptor"),
                             view_field<&FieldView::robdef_type>("robdef_type"),
                             view_field<&FieldView::declaration>("declaration")};
  return type;
}

template <>
const ViewType& view_type<RecordView>() {
  static const ViewType type{view_field<&RecordView::wire_name>("wire_name"),
                             view_field<&RecordView::name>("name"),
                             view_field<&RecordView::qualified>("qualified"),
                             view_field<&RecordView::doc>("doc"),
                             view_field<&RecordView::kind>("kind"),
                             view_field<&RecordView::is_struct>("is_struct"),
                             view_field<&RecordView::is_pod>("is_pod"),
                             view_field<&RecordView::is_namedarray>("is_namedarray"),
                             view_field<&RecordView::number_type>("number_type"),
                             view_field<&RecordView::number_count>("number_count"),
                             view_field<&RecordView::constants>("constants"),
                             view_field<&RecordView::fields>("fields"),
                             view_field<&RecordView::has_fields>("has_fields"),
                             view_field<&RecordView::table>("table"),
                             view_field<&RecordView::field_table>("field_table"),
                             view_field<&RecordView::field_rows>("field_rows"),
                             view_field<&RecordView::table_definition>("table_definition"),
                             view_field<&RecordView::specialization>("specialization")};
  return type;
}

template <>
const ViewType& view_type<ParameterView>() {
  static const ViewType type{view_field<&ParameterView::wire_name>("wire_name"),
                             view_field<&ParameterView::name>("name"),
                             view_field<&ParameterView::type>("type"),
                             view_field<&ParameterView::passed>("passed"),
                             view_field<&ParameterView::local>("local"),
                             view_field<&ParameterView::descriptor>("descriptor"),
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
                             view_field<&MemberView::number>("number"),
                             view_field<&MemberView::entry>("entry"),
                             view_field<&MemberView::is_readonly>("is_readonly"),
                             view_field<&MemberView::is_writeonly>("is_writeonly"),
                             view_field<&MemberView::is_unreliable>("is_unreliable"),
                             view_field<&MemberView::is_nolock>("is_nolock"),
                             view_field<&MemberView::is_nolockread>("is_nolockread"),
                             view_field<&MemberView::is_perclient>("is_perclient"),
                             view_field<&MemberView::is_urgent>("is_urgent"),
                             view_field<&MemberView::can_get>("can_get"),
                             view_field<&MemberView::can_set>("can_set"),
                             view_field<&MemberView::type>("type"),
                             view_field<&MemberView::passed>("passed"),
                             view_field<&MemberView::descriptor>("descriptor"),
                             view_field<&MemberView::robdef_type>("robdef_type"),
                             view_field<&MemberView::value>("value"),
                             view_field<&MemberView::local>("local"),
                             view_field<&MemberView::item>("item"),
                             view_field<&MemberView::is_multi>("is_multi"),
                             view_field<&MemberView::handle>("handle"),
                             view_field<&MemberView::served>("served"),
                             view_field<&MemberView::stored>("stored"),
                             view_field<&MemberView::has_result>("has_result"),
                             view_field<&MemberView::parameters>("parameters"),
                             view_field<&MemberView::has_parameters>("has_parameters"),
                             view_field<&MemberView::arguments>("arguments"),
                             view_field<&MemberView::parameter_table>("parameter_table"),
                             view_field<&MemberView::is_generator>("is_generator"),
                             view_field<&MemberView::yields>("yields"),
                             view_field<&MemberView::generator_parameter>("generator_parameter"),
                             view_field<&MemberView::object_type>("object_type"),
                             view_field<&MemberView::is_varobject>("is_varobject"),
                             view_field<&MemberView::stub>("stub"),
                             view_field<&MemberView::skeleton>("skeleton"),
                             view_field<&MemberView::qualified_stub>("qualified_stub"),
                             view_field<&MemberView::qualified_skeleton>("qualified_skeleton"),
                             view_field<&MemberView::has_index>("has_index"),
                             view_field<&MemberView::has_int32_index>("has_int32_index"),
                             view_field<&MemberView::has_string_index>("has_string_index"),
                             view_field<&MemberView::getter>("getter"),
                             view_field<&MemberView::setter>("setter"),
                             view_field<&MemberView::token>("token"),
                             view_field<&MemberView::stub_get>("stub_get"),
                             view_field<&MemberView::stub_set>("stub_set"),
                             view_field<&MemberView::stub_call>("stub_call"),
                             view_field<&MemberView::stub_handle>("stub_handle"),
                             view_field<&MemberView::stub_find>("stub_find"),
                             view_field<&MemberView::stub_find_definition>("stub_find_definition"),
                             view_field<&MemberView::async_get>("async_get"),
                             view_field<&MemberView::async_set>("async_set"),
                             view_field<&MemberView::async_call>("async_call"),
                             view_field<&MemberView::async_find>("async_find"),
                             view_field<&MemberView::skeleton_get>("skeleton_get"),
                             view_field<&MemberView::skeleton_set>("skeleton_set"),
                             view_field<&MemberView::skeleton_handle>("skeleton_handle"),
                             view_field<&MemberView::skeleton_call>("skeleton_call"),
                             view_field<&MemberView::skeleton_async>("skeleton_async"),
                             view_field<&MemberView::skeleton_fire>("skeleton_fire"),
                             view_field<&MemberView::skeleton_find>("skeleton_find"),
                             view_field<&MemberView::dispatch_read>("dispatch_read"),
                             view_field<&MemberView::dispatch_call>("dispatch_call"),
                             view_field<&MemberView::dispatch_find>("dispatch_find"),
                             view_field<&MemberView::default_get>("default_get"),
                             view_field<&MemberView::default_set>("default_set"),
                             view_field<&MemberView::default_call>("default_call"),
                             view_field<&MemberView::default_find>("default_find")};
  return type;
}

template <>
const ViewType& view_type<BaseView>() {
  static const ViewType type{view_field<&BaseView::wire_name>("wire_name"),
                             view_field<&BaseView::stub>("stub"),
                             view_field<&BaseView::skeleton>("skeleton")};
  return type;
}

template <>
const ViewType& view_type<ObjectView>() {
  static const ViewType type{view_field<&ObjectView::wire_name>("wire_name"),
                             view_field<&ObjectView::short_name>("short_name"),
                             view_field<&ObjectView::name>("name"),
                             view_field<&ObjectView::stub_doc>("stub_doc"),
                             view_field<&ObjectView::skeleton_doc>("skeleton_doc"),
                             view_field<&ObjectView::default_doc>("default_doc"),
                             view_field<&ObjectView::stub>("stub"),
                             view_field<&ObjectView::skeleton>("skeleton"),
                             view_field<&ObjectView::default_class>("default_class"),
                             view_field<&ObjectView::qualified_stub>("qualified_stub"),
                             view_field<&ObjectView::qualified_skeleton>("qualified_skeleton"),
                             view_field<&ObjectView::qualified_default>("qualified_default"),
                             view_field<&ObjectView::stub_head>("stub_head"),
                             view_field<&ObjectView::skeleton_head>("skeleton_head"),
                             view_field<&ObjectView::default_head>("default_head"),
                             view_field<&ObjectView::has_default>("has_default"),
                             view_field<&ObjectView::implements>("implements"),
                             view_field<&ObjectView::has_implements>("has_implements"),
                             view_field<&ObjectView::constants>("constants"),
                             view_field<&ObjectView::has_constants>("has_constants"),
                             view_field<&ObjectView::members>("members"),
                             view_field<&ObjectView::has_members>("has_members"),
                             view_field<&ObjectView::has_parameters>("has_parameters"),
                             view_field<&ObjectView::has_calls>("has_calls"),
                             view_field<&ObjectView::has_objrefs>("has_objrefs"),
                             view_field<&ObjectView::has_memories>("has_memories"),
                             view_field<&ObjectView::member_count>("member_count"),
                             view_field<&ObjectView::table>("table"),
                             view_field<&ObjectView::member_table>("member_table"),
                             view_field<&ObjectView::member_rows>("member_rows"),
                             view_field<&ObjectView::implements_table>("implements_table"),
                             view_field<&ObjectView::parameter_tables>("parameter_tables"),
                             view_field<&ObjectView::stub_type>("stub_type"),
                             view_field<&ObjectView::skeleton_type>("skeleton_type"),
                             view_field<&ObjectView::dispatch_head>("dispatch_head"),
                             view_field<&ObjectView::child_head>("child_head"),
                             view_field<&ObjectView::memory_head>("memory_head")};
  return type;
}

template <>
const ViewType& view_type<DeclarationView>() {
  static const ViewType type{view_field<&DeclarationView::constant>("constant"),
                             view_field<&DeclarationView::exception>("exception"),
                             view_field<&DeclarationView::enumeration>("enumeration"),
                             view_field<&DeclarationView::record>("record"),
                             view_field<&DeclarationView::object>("object"),
                             view_field<&DeclarationView::ends_group>("ends_group"),
                             view_field<&DeclarationView::is_early>("is_early")};
  return type;
}

template <>
const ViewType& view_type<ForwardView>() {
  static const ViewType type{view_field<&ForwardView::declaration>("declaration")};
  return type;
}

template <>
const ViewType& view_type<ImportView>() {
  static const ViewType type{view_field<&ImportView::wire_name>("wire_name"),
                             view_field<&ImportView::header>("header"),
                             view_field<&ImportView::definition>("definition")};
  return type;
}

template <>
const ViewType& view_type<DefinitionView>() {
  static const ViewType type{view_field<&DefinitionView::wire_name>("wire_name"),
                             view_field<&DefinitionView::space>("space"),
                             view_field<&DefinitionView::qualified>("qualified"),
                             view_field<&DefinitionView::path>("path"),
                             view_field<&DefinitionView::header>("header"),
                             view_field<&DefinitionView::doc>("doc"),
                             view_field<&DefinitionView::includes>("includes"),
                             view_field<&DefinitionView::import_includes>("import_includes"),
                             view_field<&DefinitionView::imports>("imports"),
                             view_field<&DefinitionView::has_imports>("has_imports"),
                             view_field<&DefinitionView::has_early>("has_early"),
                             view_field<&DefinitionView::aliases>("aliases"),
                             view_field<&DefinitionView::has_aliases>("has_aliases"),
                             view_field<&DefinitionView::forwards>("forwards"),
                             view_field<&DefinitionView::has_forwards>("has_forwards"),
                             view_field<&DefinitionView::declarations>("declarations"),
                             view_field<&DefinitionView::has_fields>("has_fields"),
                             view_field<&DefinitionView::has_records>("has_records"),
                             view_field<&DefinitionView::has_exceptions>("has_exceptions"),
                             view_field<&DefinitionView::has_objects>("has_objects"),
                             view_field<&DefinitionView::import_rows>("import_rows"),
                             view_field<&DefinitionView::record_rows>("record_rows"),
                             view_field<&DefinitionView::exception_rows>("exception_rows"),
                             view_field<&DefinitionView::object_rows>("object_rows"),
                             view_field<&DefinitionView::text>("text"),
                             view_field<&DefinitionView::version>("version")};
  return type;
}

template <>
const ViewType& view_type<ModelView>() {
  static const ViewType type{view_field<&ModelView::definitions>("definitions")};
  return type;
}

}  // namespace robdef
