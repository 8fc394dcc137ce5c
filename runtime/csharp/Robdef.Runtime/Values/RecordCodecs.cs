// SPDX-License-Identifier: Apache-2.0
using System;
using System.Text;

namespace Robdef.Runtime;

/// <summary>What the codecs of structs, pods and namedarrays have in common.</summary>
public interface IRecordCodec
{
    /// <summary>`example.geometry.Pose`: as it stands in elements.</summary>
    string QualifiedName { get; }

    /// <summary>The value of an element of a varvalue. Throws DataTypeMismatch when it is no such type.</summary>
    VarValue ReadVarying(scoped in Element element);
}

/// <summary>The codec of a struct, which generated code derives from.</summary>
/// <typeparam name="T">The record.</typeparam>
/// <param name="qualifiedName">`example.geometry.Pose`</param>
/// <param name="fieldCount">How many fields it has.</param>
public abstract class StructCodec<T>(string qualifiedName, int fieldCount) : ValueCodec<T?>, IRecordCodec
    where T : class
{
    private readonly byte[] _name = Encoding.UTF8.GetBytes(qualifiedName);

    /// <inheritdoc/>
    public string QualifiedName => qualifiedName;

    /// <inheritdoc/>
    public override void Write(ElementWriter writer, scoped in ElementKey key, T? value)
    {
        if (value is null)
        {
            NullValue.Write(writer, key);
            return;
        }
        int begin = writer.BeginElement();
        WriteFields(writer, value);
        writer.EndElement(begin, key, ElementType.Structure, _name, fieldCount);
    }

    /// <inheritdoc/>
    public override T? Read(scoped in Element element)
    {
        if (element.Type == ElementType.Void)
        {
            return null;
        }
        element.Expect(ElementType.Structure);
        if (!element.TypeName.SequenceEqual(_name))
        {
            // The recorded library reads it as what it says it is, and then fails.
            element.Registry.Find(element).ReadVarying(element);
            throw element.Error(ErrorCode.DataTypeMismatch, $"is a `{Encoding.UTF8.GetString(element.TypeName)}`, not a `{qualifiedName}`");
        }
        FieldReader fields = element.Fields;
        return ReadFields(ref fields);
    }

    VarValue IRecordCodec.ReadVarying(scoped in Element element)
    {
        element.Expect(ElementType.Structure);
        return new VarValue(Read(element)!, this);
    }

    /// <summary>Writes the fields from the last to the first.</summary>
    protected abstract void WriteFields(ElementWriter writer, T value);

    /// <summary>Reads the fields in their order.</summary>
    protected abstract T ReadFields(scoped ref FieldReader fields);
}

/// <summary>The codec of a pod, which generated code derives from.</summary>
/// <typeparam name="T">The record.</typeparam>
/// <param name="qualifiedName">`example.geometry.Pose`</param>
/// <param name="fieldCount">How many fields it has.</param>
/// <param name="packedSize">The most bytes that one takes in message version 2.</param>
public abstract class PodCodec<T>(string qualifiedName, int fieldCount, long packedSize) : ItemCodec<T>, IRecordCodec
    where T : class
{
    private readonly byte[] _name = Encoding.UTF8.GetBytes(qualifiedName);

    /// <inheritdoc/>
    public string QualifiedName => qualifiedName;

    internal override ElementType ArrayType => ElementType.PodArray;

    internal override ElementType MultiDimType => ElementType.PodMultiDimArray;

    internal override ReadOnlySpan<byte> TypeName => _name;

    internal override uint TransferSize => (uint)Math.Min(packedSize, uint.MaxValue);

    /// <inheritdoc/>
    public override void WriteItems(ElementWriter writer, scoped in ElementKey key, scoped ReadOnlySpan<T> items)
    {
        int begin = writer.BeginElement();
        for (int i = items.Length - 1; i >= 0; --i)
        {
            int item = writer.BeginElement();
            WriteFields(writer, items[i] ?? throw NullValue.Error(key));
            writer.EndElement(item, new ElementKey(i), ElementType.Pod, default, fieldCount);
        }
        writer.EndElement(begin, key, ElementType.PodArray, _name, items.Length);
    }

    /// <inheritdoc/>
    public override T Read(scoped in Element element)
    {
        if (CountItems(element) != 1)
        {
            throw element.Error(ErrorCode.DataTypeError, $"holds {element.Count} pods where one is due");
        }
        T? item = null;
        ReadItems(element, new Span<T>(ref item!));
        return item;
    }

    /// <inheritdoc/>
    public override int CountItems(scoped in Element element)
    {
        element.Expect(ElementType.PodArray);
        element.ExpectTypeName(_name);
        return element.Count;
    }

    /// <inheritdoc/>
    public override void ReadItems(scoped in Element element, Span<T> items)
    {
        ElementReader reader = element.Nested;
        for (int i = 0; i < items.Length; ++i)
        {
            Element item = reader.Read();
            item.Expect(ElementType.Pod);
            if (!item.TryGetNumber(out int number) || number != i)
            {
                throw item.Error(ErrorCode.DataTypeError, $"stands in an array of pods at place {i}");
            }
            FieldReader fields = item.Fields;
            items[i] = ReadFields(ref fields);
        }
    }

    VarValue IRecordCodec.ReadVarying(scoped in Element element) => element.Type == ElementType.PodMultiDimArray
        ? new VarValue(MultiDim.Read(element), MultiDim)
        : new VarValue(Array.Read(element), Array);

    /// <summary>Writes the fields from the last to the first.</summary>
    protected abstract void WriteFields(ElementWriter writer, T value);

    /// <summary>Reads the fields in their order.</summary>
    protected abstract T ReadFields(scoped ref FieldReader fields);
}
