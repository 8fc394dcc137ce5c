// SPDX-License-Identifier: Apache-2.0
// Service definitions, all versions of the language, the dialect of 2011 included. README.md shows
// each rule beside an example. The compiler enters at the rules of single lines, so that a line
// with a mistake disturbs no other; `definition` is the whole.
parser grammar RobdefParser;

options {
  tokenVocab = RobdefLexer;
}

definition
  : serviceLine (stdverLine | optionLine)* (importLine | optionLine)* (usingLine | optionLine)*
    (exceptionLine | constantLine | enumBlock | optionLine)*
    (recordBlock | objectBlock | optionLine)* EOF
  ;

enumBlock : enumHeader (joinedEnumLine* enumLine)? endLine ;

recordBlock : recordHeader (optionLine | constantLine)* (optionLine | fieldLine)* endLine ;

objectBlock
  : objectHeader (optionLine | implementsLine | constantLine)* (optionLine | memberLine)* endLine
  ;

// Lines outside of blocks.

serviceLine : SERVICE dotted NL ;

stdverLine : STDVER VERSION NL ;

optionLine
  : OPTION OPTION_VERSION VERSION NL # optionVersion
  | OPTION OPTION_CONSTANT constantParts NL # optionConstant
  | OPTION OPTION_WORD OPTION_TEXT? NL # optionOther
  ;

importLine : IMPORT dotted NL ;

usingLine : USING DOTTED (AS NAME)? NL ;

exceptionLine : EXCEPTION dotted NL ;

constantLine : CONSTANT constantParts NL ;

// Blocks: their first and last lines, and what stands between.

enumHeader : ENUM NAME NL ;

recordHeader
  : STRUCT NAME NL # structHeader
  | POD NAME NL # podHeader
  | NAMEDARRAY NAME NL # namedarrayHeader
  ;

objectHeader : OBJECT NAME NL ;

endLine : END BLOCK_KIND? NL ;

// All lines of an enum but its last.
joinedEnumLine : enumValue (COMMA enumValue)* COMMA+ NL ;

enumLine : enumValue (COMMA enumValue)* COMMA* NL ;

enumValue : ENUM_WORD (EQUALS enumNumber)? ;

enumNumber
  : INT # enumDecimal
  | HEX # enumHexadecimal
  ;

implementsLine : IMPLEMENTS dotted NL ;

fieldLine : FIELD type SPACED_WORD modifiers? NL ;

memberLine
  : PROPERTY type SPACED_WORD modifiers? NL # property
  | FUNCTION type SPACED_WORD parameters modifiers? NL # function
  | EVENT eventName parameters modifiers? NL # event
  | OBJREF type SPACED_WORD modifiers? NL # objref
  | PIPE type SPACED_WORD modifiers? NL # pipe
  | CALLBACK type SPACED_WORD parameters modifiers? NL # callback
  | WIRE type SPACED_WORD modifiers? NL # wire
  | MEMORY type SPACED_WORD modifiers? NL # memory
  ;

eventName
  : MEMBER_WORD # usualEventName
  | MEMBER_OTHER_WORD # otherEventName
  ;

// Names and types.

dotted
  : NAME # plainName
  | DOTTED # dottedName
  ;

type
  : MEMBER_WORD array? container? # plainType
  | MEMBER_QUALIFIED array? container? # qualifiedType
  ;

array
  : OPEN_ARRAY CLOSE_ARRAY # anyLength
  | OPEN_ARRAY DIGITS CLOSE_ARRAY # fixedLength
  | OPEN_ARRAY DIGITS MINUS CLOSE_ARRAY # maximumLength
  | OPEN_ARRAY STAR CLOSE_ARRAY # anyShape
  | OPEN_ARRAY DIGITS COMMA CLOSE_ARRAY # fixedLine
  | OPEN_ARRAY DIGITS (COMMA DIGITS)+ CLOSE_ARRAY # fixedShape
  ;

container : OPEN_CONTAINER CONTAINER_KIND CLOSE_CONTAINER ;

// Parameters and modifiers of members.

parameters : OPEN_PARAMETERS (parameter (COMMA parameter)*)? CLOSE_PARAMETERS ;

parameter : type SPACED_WORD ;

modifiers : OPEN_MODIFIERS modifier (COMMA modifier)* COMMA? CLOSE_MODIFIERS ;

modifier : NAME arguments? ;

arguments
  : OPEN_ARGUMENTS argument ((COMMA | SPACED_COMMA) argument (COMMA argument)*)? CLOSE_ARGUMENTS
  ;

argument
  : INT # decimalArgument
  | HEX # hexadecimalArgument
  | FLOAT # floatArgument
  | NAME # nameArgument
  ;

// Constants. Which value fits which type is checked later.

constantParts : constantType NAME constantValue ;

constantType : dotted array? container? ;

constantValue
  : number # numberValue
  | STRING # stringValue
  | OPEN_VALUE (number (COMMA number)*)? CLOSE_VALUE # arrayValue
  | OPEN_VALUE constantField (COMMA constantField)* CLOSE_VALUE # structValue
  ;

number
  : INT # decimalNumber
  | HEX # hexadecimalNumber
  | FLOAT # floatNumber
  ;

constantField : NAME COLON NAME ;
