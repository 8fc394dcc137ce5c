// SPDX-License-Identifier: Apache-2.0
namespace Robdef.Runtime;

/// <summary>Arrays of pods.</summary>
public static class Pods
{
    /// <summary>An array whose items are all there: none of a pod's may be null.</summary>
    public static T[] New<T>(int count)
        where T : class, new()
    {
        var items = new T[count];
        for (int i = 0; i < count; ++i)
        {
            items[i] = new T();
        }
        return items;
    }
}
