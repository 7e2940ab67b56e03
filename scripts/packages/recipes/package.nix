# SPDX-License-Identifier: BSD-3-Clause
# nix-build -E 'with import <nixpkgs> {}; callPackage ./package.nix {}'
{ lib, stdenv, cmake, ninja, python3, bash, eigen, cli11, nlohmann_json, boost, libpng, zlib, pugixml, metis, muparser }:

stdenv.mkDerivation {
  pname = "meshpipe";
  version = "0.2.0";
  src = ../../..;
  nativeBuildInputs = [ cmake ninja python3 ];
  buildInputs = [ bash eigen cli11 nlohmann_json boost libpng zlib pugixml metis muparser ];
  cmakeFlags = [ "-DBUILD_TESTING=OFF" "-DMESHPIPE_ARCHIVES=OFF" ];
  meta = {
    description = "Unix filters that remesh triangulated surfaces";
    license = lib.licenses.bsd3;
    platforms = lib.platforms.linux;
    mainProgram = "mremesh";
  };
}
