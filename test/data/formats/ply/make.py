# SPDX-License-Identifier: BSD-3-Clause
"""Writes the PLY files of this folder with other programs: VTK (python3-vtk9 9.1.0) and PCL (pcl-tools 1.13.0).

make.mjs adds files and reads all of them with three.js, which gives the values that gaussmap must return.
Run: /usr/bin/python3 make.py && node make.mjs
"""
import os
import random
import subprocess

import vtk

R = random.Random(5)
COUNT = 24


def cloud(with_faces, point_type):
    points = vtk.vtkPoints()
    points.SetDataType(point_type)
    colours = vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    colours.SetName("colours")
    faces = vtk.vtkCellArray()
    for i in range(COUNT):
        points.InsertNextPoint(R.uniform(-90, 90), R.uniform(-90, 90), R.uniform(-2, 9))
        colours.InsertNextTuple3(*(R.randrange(256) for _ in range(3)))
        if with_faces and i >= 2:
            faces.InsertNextCell(3, (i - 2, i - 1, i))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(faces)
    data.GetPointData().AddArray(colours)
    return data


def write_vtk(name, encoding, with_faces):
    writer = vtk.vtkPLYWriter()
    writer.SetInputData(cloud(with_faces, vtk.VTK_FLOAT))
    writer.SetArrayName("colours")
    writer.SetFileName(name)
    if encoding == "ascii":
        writer.SetFileTypeToASCII()
    else:
        writer.SetFileTypeToBinary()
        if encoding == "big":
            writer.SetDataByteOrderToBigEndian()
        else:
            writer.SetDataByteOrderToLittleEndian()
    writer.Write()


write_vtk("vtk_ascii.ply", "ascii", True)
write_vtk("vtk_little.ply", "little", True)
write_vtk("vtk_big.ply", "big", False)

with open("pcl.pcd", "w") as pcd:
    print("VERSION .7\nFIELDS x y z intensity ring\nSIZE 4 4 4 4 2\nTYPE F F F F U\nCOUNT 1 1 1 1 1", file=pcd)
    print("WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii" % (COUNT, COUNT), file=pcd)
    for i in range(COUNT):
        x = "nan" if i == 3 else R.uniform(-90, 90)
        print(x, R.uniform(-90, 90), R.uniform(-2, 9), R.randrange(256), i % 16, file=pcd)
for kind, camera in (("0", "0"), ("1", "1")):
    subprocess.run(["pcl_pcd2ply", "-format", kind, "-use_camera", camera, "pcl.pcd",
                    ("pcl_ascii.ply", "pcl_binary.ply")[int(kind)]], check=True, stdout=subprocess.DEVNULL)
os.remove("pcl.pcd")
