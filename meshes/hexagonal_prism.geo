// SPDX-License-Identifier: LGPL-2.1-or-later
// A hexagonal prism, 5 cm from the axis to the corners and 60 cm long, in metres.
// gmsh -3 -format msh2 hexagonal_prism.geo
radius = 0.05;
length = 0.6;
size   = 0.025;

For k In {0 : 5}
  Point(k + 1) = {radius * Cos(k * Pi / 3), radius * Sin(k * Pi / 3), 0, size};
EndFor
For k In {1 : 6}
  Line(k) = {k, k % 6 + 1};
EndFor
Curve Loop(1)    = {1 : 6};
Plane Surface(1) = {1};
prism[]          = Extrude {0, 0, length} { Surface{1}; Layers{24}; };
Physical Volume(1) = {prism[1]};
