// SPDX-License-Identifier: Apache-2.0
namespace Robdef.Runtime;

/// <summary>The type number of a message element (01, section 5).</summary>
public enum ElementType
{
#pragma warning disable CS1591 // The words of the protocol.
    Void = 0,
    Double = 1,
    Single = 2,
    Int8 = 3,
    UInt8 = 4,
    Int16 = 5,
    UInt16 = 6,
    Int32 = 7,
    UInt32 = 8,
    Int64 = 9,
    UInt64 = 10,
    String = 11,
    ComplexDouble = 12,
    ComplexSingle = 13,
    Bool = 14,
    Structure = 101,
    Int32Map = 102,
    StringMap = 103,
    List = 108,
    Pod = 109,
    PodArray = 110,
    PodMultiDimArray = 111,
    NamedArray = 115,
    NamedMultiDimArray = 116,
    MultiDimArray = 117,
#pragma warning restore CS1591
}

/// <summary>The two layouts of messages; both sides of a session use the one they agreed on.</summary>
public enum MessageVersion
{
    /// <summary>Fixed sizes, which every peer knows (01).</summary>
    V2 = 2,

    /// <summary>Fewer bytes: sizes of variable length, fields that may be absent (02).</summary>
    V4 = 4,
}

/// <summary>Facts about element types.</summary>
public static class ElementTypes
{
    /// <summary>The deepest nesting that is read or written.</summary>
    public const int MaximumDepth = 64;

    /// <summary>Bytes of one item on the wire: 8 for double, 1 for string and bool; 0 for void and nested types.</summary>
    public static int SizeOf(ElementType type) => type switch
    {
        ElementType.Int8 or ElementType.UInt8 or ElementType.String or ElementType.Bool => 1,
        ElementType.Int16 or ElementType.UInt16 => 2,
        ElementType.Single or ElementType.Int32 or ElementType.UInt32 => 4,
        ElementType.Double or ElementType.Int64 or ElementType.UInt64 or ElementType.ComplexSingle => 8,
        ElementType.ComplexDouble => 16,
        _ => 0,
    };

    /// <summary>Whether the payload is a row of elements.</summary>
    public static bool IsNested(ElementType type) => type is ElementType.Structure or ElementType.Int32Map
        or ElementType.StringMap or ElementType.List or ElementType.Pod or ElementType.PodArray
        or ElementType.PodMultiDimArray or ElementType.NamedArray or ElementType.NamedMultiDimArray
        or ElementType.MultiDimArray;

    /// <summary>Whether there is an element type of this number.</summary>
    public static bool IsKnown(ElementType type) =>
        type == ElementType.Void || SizeOf(type) != 0 || IsNested(type);
}
