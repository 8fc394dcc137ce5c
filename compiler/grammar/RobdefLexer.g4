// SPDX-License-Identifier: Apache-2.0
// Tokens of service definitions. The text consists of logical lines: continued lines are joined,
// blanks at both ends of a line, empty lines and comments are gone. See README.md.
//
// A keyword is one only at the start of a line, so there each keyword enters the mode in which the
// rest of its line is read. Where blanks decide something they are part of a token: ` [` begins
// modifiers, `[` an array. All others are skipped. Tokens that no rule of the parser uses (most of
// OTHER_..., SPACED_..., GLUED_...) catch what would otherwise pass.
lexer grammar RobdefLexer;

SERVICE : 'service' Blank* -> mode(Names) ;
STDVER : 'stdver' Blank* -> mode(Version) ;
OPTION : 'option' Blank* -> mode(Option) ;
IMPORT : 'import' Blank* -> mode(Names) ;
USING : 'using' Blank* -> mode(Names) ;
EXCEPTION : 'exception' Blank* -> mode(Names) ;
CONSTANT : 'constant' Blank* -> mode(Constant) ;
ENUM : 'enum' Blank* -> mode(EnumHeader) ;
STRUCT : 'struct' Blank* -> mode(Names) ;
POD : 'pod' Blank* -> mode(Names) ;
NAMEDARRAY : 'namedarray' Blank* -> mode(Names) ;
OBJECT : 'object' Blank* -> mode(Names) ;
END : 'end' Blank* -> mode(Closing) ;
IMPLEMENTS : 'implements' Blank* -> mode(Names) ;
FIELD : 'field' Blank* -> mode(Member) ;
PROPERTY : 'property' Blank* -> mode(Member) ;
FUNCTION : 'function' Blank* -> mode(Member) ;
EVENT : 'event' Blank* -> mode(Member) ;
OBJREF : 'objref' Blank* -> mode(Member) ;
PIPE : 'pipe' Blank* -> mode(Member) ;
CALLBACK : 'callback' Blank* -> mode(Member) ;
WIRE : 'wire' Blank* -> mode(Member) ;
MEMORY : 'memory' Blank* -> mode(Member) ;
OTHER_WORD : WordChar+ ;
NL : '\n' ;
SKIPPED : Blank+ -> skip ;
UNEXPECTED : . ;

fragment Letter : [A-Za-z] ;
fragment Digit : [0-9] ;
fragment HexDigit : [0-9A-Fa-f] ;
fragment WordChar : [A-Za-z0-9_] ;
fragment Blank : [ \t] ;
fragment Segment : Letter (WordChar* (Letter | Digit))? ;
fragment Sign : [+-] ;
fragment Whole : '0' | [1-9] Digit* ;
fragment Escape : '\\' (["\\/bfnrt] | 'u' HexDigit HexDigit HexDigit HexDigit) ;

// service, import, using, exception, implements and block headers: names only.
mode Names;
NAME : Segment ;
DOTTED : Segment ('.' Segment)+ ;
AS : Blank+ 'as' Blank ;
SPACED_AS : Blank+ 'as' Blank Blank+ ;
Names_OTHER : [A-Za-z0-9_.]+ -> type(OTHER_WORD) ;
Names_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Names_SKIPPED : Blank+ -> skip ;
Names_UNEXPECTED : . -> type(UNEXPECTED) ;

mode Version;
VERSION : Digit+ '.' Digit+ ('.' Digit+ ('.' Digit+)?)? ;
Version_OTHER : [A-Za-z0-9_.]+ -> type(OTHER_WORD) ;
Version_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Version_SKIPPED : Blank+ -> skip ;
Version_UNEXPECTED : . -> type(UNEXPECTED) ;

// option: any text, but for two old spellings.
mode Option;
OPTION_VERSION : 'version' Blank+ -> mode(Version) ;
OPTION_CONSTANT : 'constant' Blank+ -> mode(Constant) ;
OPTION_WORD : WordChar+ -> mode(OptionText) ;
Option_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Option_SKIPPED : Blank+ -> skip ;
Option_UNEXPECTED : . -> type(UNEXPECTED) ;

mode OptionText;
OPTION_TEXT : ~[\n]+ ;
OptionText_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;

mode Closing;
BLOCK_KIND : 'struct' | 'pod' | 'namedarray' | 'object' | 'enum' ;
Closing_OTHER : WordChar+ -> type(OTHER_WORD) ;
Closing_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Closing_SKIPPED : Blank+ -> skip ;
Closing_UNEXPECTED : . -> type(UNEXPECTED) ;

// Fields and members. A name is a blank and a word; which words are good names is checked later.
mode Member;
MEMBER_WORD : Letter WordChar* ;
MEMBER_QUALIFIED : Letter (WordChar | '.')* ;
MEMBER_OTHER_WORD : [0-9_] WordChar* ;
SPACED_WORD : Blank+ WordChar+ ;
OPEN_PARAMETERS : Blank* '(' Blank* ;
CLOSE_PARAMETERS : Blank* ')' ;
COMMA : Blank* ',' Blank* ;
OPEN_ARRAY : '[' -> pushMode(Array) ;
OPEN_CONTAINER : '{' -> pushMode(Container) ;
OPEN_MODIFIERS : Blank+ '[' -> mode(Modifiers) ;
SPACED_CONTAINER : Blank+ '{' ;
Member_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Member_SKIPPED : Blank+ -> skip ;
Member_UNEXPECTED : . -> type(UNEXPECTED) ;

// Inside a type there are no blanks.
mode Array;
DIGITS : Digit+ ;
MINUS : '-' ;
STAR : '*' ;
Array_COMMA : ',' -> type(COMMA) ;
CLOSE_ARRAY : ']' -> popMode ;
GLUED_ARRAY : ']' WordChar -> popMode ;
Array_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Array_UNEXPECTED : . -> type(UNEXPECTED) ;

mode Container;
CONTAINER_KIND : 'list' | 'int32' | 'string' | 'generator' ;
Container_OTHER : WordChar+ -> type(OTHER_WORD) ;
CLOSE_CONTAINER : '}' -> popMode ;
GLUED_CONTAINER : '}' WordChar -> popMode ;
Container_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Container_UNEXPECTED : . -> type(UNEXPECTED) ;

mode Modifiers;
Modifiers_NAME : Segment -> type(NAME) ;
Modifiers_COMMA : ',' -> type(COMMA) ;
OPEN_ARGUMENTS : '(' -> mode(Arguments) ;
SPACED_ARGUMENTS : Blank+ '(' ;
CLOSE_MODIFIERS : ']' ;
SPACED_MODIFIERS : Blank+ ']' ;
Modifiers_OTHER : WordChar+ -> type(OTHER_WORD) ;
Modifiers_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Modifiers_SKIPPED : Blank+ -> skip ;
Modifiers_UNEXPECTED : . -> type(UNEXPECTED) ;

// Arguments of a modifier. A blank may stand before the first comma only.
mode Arguments;
Arguments_INT : Sign? Whole -> type(INT) ;
Arguments_HEX : Sign? '0x' HexDigit+ -> type(HEX) ;
Arguments_FLOAT : Sign? (Whole ('.' Digit*)? | '.' Digit+) ([eE] Sign? Digit+)? -> type(FLOAT) ;
Arguments_NAME : Segment -> type(NAME) ;
Arguments_COMMA : ',' -> type(COMMA) ;
SPACED_COMMA : Blank+ ',' ;
CLOSE_ARGUMENTS : ')' -> mode(Modifiers) ;
Arguments_OTHER : WordChar [A-Za-z0-9_.+-]* -> type(OTHER_WORD) ;
Arguments_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Arguments_SKIPPED : Blank+ -> skip ;
Arguments_UNEXPECTED : . -> type(UNEXPECTED) ;

mode Constant;
INT : Sign? Whole ;
HEX : Sign? '0x' HexDigit+ ;
FLOAT : Sign? (Whole ('.' Digit*)? | '.' Digit+) ([eE] Sign? Digit+)? ;
STRING : '"' (~["\\\n] | Escape)* '"' ;
Constant_NAME : Segment -> type(NAME) ;
Constant_DOTTED : Segment ('.' Segment)+ -> type(DOTTED) ;
Constant_COMMA : ',' -> type(COMMA) ;
COLON : ':' ;
Constant_OPEN_ARRAY : '[' -> type(OPEN_ARRAY), pushMode(Array) ;
Constant_OPEN_CONTAINER : '{' -> type(OPEN_CONTAINER), pushMode(Container) ;
OPEN_VALUE : Blank+ '{' ;
CLOSE_VALUE : '}' ;
GLUED_STRING : WordChar [A-Za-z0-9_.+-]* '"' -> type(OTHER_WORD) ;
Constant_OTHER : WordChar [A-Za-z0-9_.+-]* -> type(OTHER_WORD) ;
Constant_NL : '\n' -> type(NL), mode(DEFAULT_MODE) ;
Constant_SKIPPED : Blank+ -> skip ;
Constant_UNEXPECTED : . -> type(UNEXPECTED) ;

mode EnumHeader;
EnumHeader_NAME : Segment -> type(NAME) ;
EnumHeader_OTHER : [A-Za-z0-9_.]+ -> type(OTHER_WORD) ;
EnumHeader_NL : '\n' -> type(NL), mode(EnumBody) ;
EnumHeader_SKIPPED : Blank+ -> skip ;
EnumHeader_UNEXPECTED : . -> type(UNEXPECTED) ;

// The start of a line inside an enum, where `end` is the only keyword.
mode EnumBody;
EnumBody_END : 'end' -> type(END), mode(Closing) ;
ENUM_WORD : Letter WordChar* -> mode(EnumValues) ;
EnumBody_OTHER : WordChar+ -> type(OTHER_WORD), mode(EnumValues) ;
EnumBody_NL : '\n' -> type(NL) ;
EnumBody_SKIPPED : Blank+ -> skip ;
EnumBody_UNEXPECTED : . -> type(UNEXPECTED), mode(EnumValues) ;

mode EnumValues;
EnumValues_WORD : Letter WordChar* -> type(ENUM_WORD) ;
EQUALS : '=' ;
EnumValues_INT : Sign? Whole -> type(INT) ;
EnumValues_HEX : Sign? '0x' HexDigit+ -> type(HEX) ;
EnumValues_COMMA : ',' -> type(COMMA) ;
EnumValues_OTHER : WordChar [A-Za-z0-9_.+-]* -> type(OTHER_WORD) ;
EnumValues_NL : '\n' -> type(NL), mode(EnumBody) ;
EnumValues_SKIPPED : Blank+ -> skip ;
EnumValues_UNEXPECTED : . -> type(UNEXPECTED) ;
