class Beltrami < Formula
  desc "UV coordinates for meshes, proven to be free of flips and overlaps"
  homepage "https://github.com/beltrami/beltrami"
  url "https://github.com/beltrami/beltrami/archive/refs/tags/v0.1.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000" # of the release's archive
  license all_of: ["Apache-2.0", "MPL-2.0", "BSD-3-Clause", "MIT", "Zlib"]

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build

  uses_from_macos "zlib"

  resource "stb" do
    url "https://github.com/nothings/stb/archive/31c1ad37456438565541f4919958214b6e762fb4.tar.gz"
    sha256 "0000000000000000000000000000000000000000000000000000000000000000" # of that archive
  end

  def install
    (buildpath/"stb").install resource("stb")
    args = %W[
      -DBELTRAMI_EXACT=own
      -DBELTRAMI_BUILD_TESTS=OFF
      -DSTB_INCLUDE_DIR=#{buildpath}/stb
    ]
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *args, *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    (testpath/"square.obj").write <<~EOS
      v 0 0 0
      v 1 0 0
      v 1 1 0
      v 0 1 0
      f 1 2 3 4
    EOS
    system bin/"beltrami", "unwrap", "square.obj", "out.obj"
    assert_match "vt ", (testpath/"out.obj").read
  end
end
