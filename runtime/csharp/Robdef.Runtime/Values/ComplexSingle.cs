// SPDX-License-Identifier: Apache-2.0
using System.Numerics;
using System.Runtime.InteropServices;

namespace Robdef.Runtime;

/// <summary>A complex number of two singles: `csingle` of a definition.</summary>
/// <param name="Real">The real part.</param>
/// <param name="Imaginary">The imaginary part.</param>
[StructLayout(LayoutKind.Sequential)]
public readonly record struct ComplexSingle(float Real, float Imaginary)
{
    /// <summary>The same number in double precision.</summary>
    public Complex ToComplex() => new(Real, Imaginary);

    /// <summary>The nearest number in single precision.</summary>
    public static ComplexSingle FromComplex(Complex value) => new((float)value.Real, (float)value.Imaginary);

    /// <summary>The same number in double precision.</summary>
    public static implicit operator Complex(ComplexSingle value) => value.ToComplex();
}
