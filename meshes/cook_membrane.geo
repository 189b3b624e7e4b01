// SPDX-License-Identifier: LGPL-2.1-or-later
// Cook's membrane with its plane of symmetry at z = 0, half a metre thick.
// gmsh -3 -format msh2 cook_membrane.geo
n = 12;

Point(1) = {0, 0, 0};
Point(2) = {48, 44, 0};
Point(3) = {48, 60, 0};
Point(4) = {0, 44, 0};
For k In {1 : 4}
  Line(k) = {k, k % 4 + 1};
EndFor
Curve Loop(1)    = {1 : 4};
Plane Surface(1) = {1};
Transfinite Curve {1 : 4} = n + 1;
Transfinite Surface {1};
Recombine Surface {1};
plate[] = Extrude {0, 0, 0.5} { Surface{1}; Layers{1}; Recombine; };
Physical Volume(1) = {plate[1]};
