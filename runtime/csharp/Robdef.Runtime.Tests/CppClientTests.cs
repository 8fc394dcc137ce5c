// SPDX-License-Identifier: Apache-2.0
using System;
using System.Diagnostics;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>A client in C++ of a service in C#.</summary>
public sealed class CppClientTests
{
    [Theory]
    [InlineData("2")]
    [InlineData("4")]
    public void A_client_in_cpp_uses_all_members(string version)
    {
        using var node = new Node();
        using Service service = node.Register("arm", new TestArm());
        int port = node.Listen("rr+tcp://127.0.0.1:0");
        using Process client = Programs.Start("csharp_arm_client", $"rr+tcp://127.0.0.1:{port}/?service=arm", version);
        string said = client.StandardOutput.ReadToEnd();
        Assert.True(client.WaitForExit(TimeSpan.FromSeconds(60)));
        Assert.Equal("", said);
        Assert.Equal(0, client.ExitCode);
    }
}
