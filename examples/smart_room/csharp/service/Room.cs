// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Threading;

namespace SmartRoom;

/// <summary>Red, green, blue; 0 is dark, 1 is a lamp's full power.</summary>
internal readonly record struct Color(double Red, double Green, double Blue);

/// <summary>A place in the room in metres: x to the east, y to the north, z up from the floor.</summary>
internal readonly record struct Place(double X, double Y, double Z);

/// <summary>
/// The simulated room of ../../cpp/room.hpp: 8 x 6 x 3 m with lamps, color sensors and four cameras, all of it computed
/// from the lamps' colors. May be used from several threads at once.
/// </summary>
internal sealed class Room
{
    public const int PictureWidth = 320;
    public const int PictureHeight = 240;

    private const double Height = 3;

    // Half of what one camera covers: a quarter of the floor.
    private const double HalfWidth = 2;
    private const double HalfDepth = 1.5;

    private readonly Lock _lock = new();
    private readonly Color[] _lights = new Color[LightPlaces.Count];

    public Room() => Array.Fill(_lights, new Color(0.4, 0.4, 0.4));

    public static IReadOnlyList<Place> LightPlaces { get; } =
        [new(1.5, 1.5, Height), new(4, 1.5, Height), new(6.5, 1.5, Height), new(1.5, 4.5, Height), new(4, 4.5, Height), new(6.5, 4.5, Height)];

    public static IReadOnlyList<Place> SensorPlaces { get; } =
        [new(1.2, 1.2, 0.8), new(6.8, 1.2, 0.8), new(1.2, 4.8, 0.8), new(6.8, 4.8, 0.8)];

    public static IReadOnlyList<Place> CameraPlaces { get; } =
        [new(2, 4.5, Height), new(6, 4.5, Height), new(2, 1.5, Height), new(6, 1.5, Height)];

    public Color[] Lights
    {
        get
        {
            lock (_lock)
            {
                return [.. _lights];
            }
        }
    }

    /// <summary>Sets the lamps first to last, counted from 1.</summary>
    public void SetLights(int first, int last, Color color)
    {
        lock (_lock)
        {
            Array.Fill(_lights, color, first - 1, last - first + 1);
        }
    }

    /// <summary>What a sensor measures, counted from 0: light from all lamps that reaches it.</summary>
    public Color Sensor(int index) => Illumination(Lights, SensorPlaces[index]);

    /// <summary>What a camera sees of the floor below it: three bytes a pixel, rows from the north, pixels from the west.</summary>
    public byte[] Picture(int camera)
    {
        Place center = CameraPlaces[camera];
        Color[] lights = Lights;
        byte[] rgb = new byte[3 * PictureWidth * PictureHeight];
        int next = 0;
        for (int row = 0; row < PictureHeight; ++row)
        {
            double y = center.Y + (HalfDepth * (1 - (((2 * row) + 1) / (double)PictureHeight)));
            for (int column = 0; column < PictureWidth; ++column)
            {
                double x = center.X + (HalfWidth * ((((2 * column) + 1) / (double)PictureWidth) - 1));
                Color light = Illumination(lights, new Place(x, y, 0));
                Color floor = Surface(x, y);
                rgb[next++] = Exposed(light.Red, floor.Red);
                rgb[next++] = Exposed(light.Green, floor.Green);
                rgb[next++] = Exposed(light.Blue, floor.Blue);
            }
        }
        return rgb;
    }

    /// <summary>
    /// Light that falls on a level surface: each lamp by the inverse square of its distance and the cosine at the lamp
    /// and at the surface.
    /// </summary>
    private static Color Illumination(Color[] lights, Place at)
    {
        Color sum = default;
        for (int i = 0; i < lights.Length; ++i)
        {
            double dx = LightPlaces[i].X - at.X;
            double dy = LightPlaces[i].Y - at.Y;
            double dz = LightPlaces[i].Z - at.Z;
            double square = (dx * dx) + (dy * dy) + (dz * dz);
            double weight = dz * dz / (square * square);
            sum = new Color(sum.Red + (lights[i].Red * weight), sum.Green + (lights[i].Green * weight), sum.Blue + (lights[i].Blue * weight));
        }
        return sum;
    }

    /// <summary>The color of what lies at a place on the floor: tiles, two tables, a round rug.</summary>
    private static Color Surface(double x, double y)
    {
        bool IsInside(double left, double bottom, double right, double top) => x >= left && x < right && y >= bottom && y < top;
        if (IsInside(0.6, 0.8, 2.2, 1.7) || IsInside(5.9, 4.3, 7.6, 5.3))
        {
            return new(0.72, 0.52, 0.33);
        }
        if (double.Hypot(x - 4, y - 3) < 1.1)
        {
            return new(0.35, 0.45, 0.62);
        }
        int tile = (int)Math.Floor(x * 2) + (int)Math.Floor(y * 2);
        return tile % 2 == 0 ? new(0.85, 0.85, 0.82) : new(0.66, 0.66, 0.68);
    }

    /// <summary>Bright parts are compressed instead of cut off, so that a lamp's color stays visible below it.</summary>
    private static byte Exposed(double light, double reflectance) =>
        (byte)Math.Round(255 * (1 - Math.Exp(-14 * light * reflectance)), MidpointRounding.AwayFromZero);
}
