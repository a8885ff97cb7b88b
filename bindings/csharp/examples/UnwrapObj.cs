// Unwraps the triangles and polygons of an OBJ file: UnwrapObj.exe IN.obj OUT.obj
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using Beltrami;

public static class UnwrapObj
{
    public static int Main(string[] arguments)
    {
        if (arguments.Length != 2) {
            Console.Error.WriteLine("usage: UnwrapObj.exe IN.obj OUT.obj");
            return 2;
        }
        List<double> positions = new List<double>();
        List<int> corners = new List<int>(), sizes = new List<int>();
        foreach (string line in File.ReadLines(arguments[0])) {
            string[] words = line.Split((char[])null, StringSplitOptions.RemoveEmptyEntries);
            if (words.Length == 0) continue;
            if (words[0] == "v") {
                for (int k = 1; k <= 3; ++k) {
                    positions.Add(double.Parse(words[k], CultureInfo.InvariantCulture));
                }
            } else if (words[0] == "f") {
                for (int k = 1; k < words.Length; ++k) {
                    corners.Add(int.Parse(words[k].Split('/')[0], CultureInfo.InvariantCulture) - 1);
                }
                sizes.Add(words.Length - 1);
            }
        }
        using (Context context = new Context()) {
            context.Options.Threads = Environment.ProcessorCount;
            context.Options.Margin = 4;
            Surface surface = new Surface(positions.ToArray(), corners.ToArray(), sizes.ToArray());
            Atlas atlas = context.Unwrap(surface);
            Write(arguments[1], positions, corners, sizes, atlas);
            Console.WriteLine("{0} charts, injective: {1}", atlas.Report.Charts, atlas.Injective);
            return atlas.Injective ? 0 : 3;
        }
    }

    static void Write(string path, List<double> positions, List<int> corners, List<int> sizes,
                      Atlas atlas)
    {
        using (StreamWriter file = new StreamWriter(path)) {
            for (int v = 0; v < positions.Count; v += 3) {
                file.WriteLine(FormattableString.Invariant(
                    $"v {positions[v]:R} {positions[v + 1]:R} {positions[v + 2]:R}"));
            }
            for (int i = 0; i < atlas.Uvs.Length; i += 2) {
                file.WriteLine(FormattableString.Invariant(
                    $"vt {atlas.Uvs[i]:R} {atlas.Uvs[i + 1]:R}"));
            }
            int corner = 0;
            foreach (int size in sizes) {
                file.Write("f");
                for (int end = corner + size; corner < end; ++corner) {
                    file.Write($" {corners[corner] + 1}/{atlas.UvOfCorner[corner] + 1}");
                }
                file.WriteLine();
            }
        }
    }
}
