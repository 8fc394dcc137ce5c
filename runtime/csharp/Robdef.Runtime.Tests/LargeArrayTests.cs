// SPDX-License-Identifier: Apache-2.0
using System.Collections.Generic;
using System.Linq;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;
using Complex = System.Numerics.Complex;

namespace Robdef.Runtime.Tests;

/// <summary>Arrays that are sent from where they are, of every kind and at every depth.</summary>
public sealed class LargeArrayTests
{
    private const int Count = 50_000;

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Arrays_arrive_as_they_were_sent(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        double[] numbers = [.. Enumerable.Range(0, Count).Select(i => i / 3.0)];
        Assert.Equal(numbers, pair.Stub.EchoedNumbers(numbers));
        Assert.Equal(numbers, await pair.Stub.EchoedNumbersAsync(numbers));
        pair.Stub.SetTrace(numbers);
        Assert.Equal(numbers, pair.Stub.GetTrace());
        numbers[Count - 1] = -1;
        await pair.Stub.SetTraceAsync(numbers);
        Assert.Equal(numbers, await pair.Stub.GetTraceAsync());
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public void Arrays_of_each_packed_type_arrive(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        bool[] truths = [.. Enumerable.Range(0, Count).Select(i => i % 3 == 0)];
        Assert.Equal(truths, Echo(pair, VarValue.Of(truths, ValueCodec.Bool.Array)).Get<bool[]>());
        Complex[] complex = [.. Enumerable.Range(0, Count).Select(i => new Complex(i, -i))];
        Assert.Equal(complex, Echo(pair, VarValue.Of(complex, ValueCodec.ComplexDouble.Array)).Get<Complex[]>());
        Vector3[] vectors = [.. Enumerable.Range(0, Count).Select(i => new Vector3 { X = i, Z = 1 })];
        Assert.Equal(vectors, Echo(pair, VarValue.Of(vectors, Vector3.RrCodec.Array)).Get<Vector3[]>());
        var grid = new MultiDimArray<float>(250, 200);
        grid[7, 3] = 1.5f;
        MultiDimArray<float> came = Echo(pair, VarValue.Of(grid, ValueCodec.Single.MultiDim)).Get<MultiDimArray<float>>();
        Assert.Equal(grid.Dims, came.Dims);
        Assert.Equal(grid.Items, came.Items);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public void Arrays_inside_of_containers_arrive(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        byte[] large = [.. Enumerable.Range(0, Count).Select(i => (byte)(i * 31))];
        byte[] small = [1, 2, 3];
        var sent = new Dictionary<string, VarValue?>
        {
            ["large"] = large,
            ["small"] = small,
            ["again"] = new List<VarValue?> { large, null, "text", large },
        };
        Dictionary<string, VarValue?> came = Echo(pair, sent).Get<Dictionary<string, VarValue?>>();
        Assert.Equal(large, came["large"]!.Get<byte[]>());
        Assert.Equal(small, came["small"]!.Get<byte[]>());
        List<VarValue?> list = came["again"]!.Get<List<VarValue?>>();
        Assert.Equal(large, list[0]!.Get<byte[]>());
        Assert.Null(list[1]);
        Assert.Equal("text", list[2]!.Get<string>());
        Assert.Equal(large, list[3]!.Get<byte[]>());
    }

    private static VarValue Echo(Pair pair, VarValue value) => pair.Stub.Echo(value)!;
}
