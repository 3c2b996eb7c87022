"""Writes the particle files of the reader tests with VTK's own writers (python3-vtk9), an independent implementation.

Usage: python3 make_particle_files.py      in this folder

Eight particles: x = k / 8, y = k^2 / 64, z = -k; velocity (k, 0.5, -k / 4); id 100 - k; radius 0.25. Time 1.5 s.
The CSV is what ParaView's "Save Data" writes of the same (vtkDelimitedTextWriter has its way of naming columns).
"""
import vtk

COUNT = 8


def named(array_type, name, components, rows):
    array = array_type()
    array.SetName(name)
    array.SetNumberOfComponents(components)
    for row in rows:
        array.InsertNextTuple(row)
    return array


def particles(points_type):
    points = vtk.vtkPoints()
    points.SetDataType(points_type)
    cells = vtk.vtkCellArray()
    for k in range(COUNT):
        points.InsertNextPoint(k / 8, k * k / 64, -k)
        cells.InsertNextCell(1, [k])
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetVerts(cells)
    attributes = data.GetPointData()
    attributes.AddArray(named(vtk.vtkFloatArray, "velocity", 3, [(k, 0.5, -k / 4) for k in range(COUNT)]))
    attributes.AddArray(named(vtk.vtkIdTypeArray, "id", 1, [(100 - k,) for k in range(COUNT)]))
    attributes.AddArray(named(vtk.vtkDoubleArray, "particle radius", 1, [(0.25,)] * COUNT))
    data.GetCellData().AddArray(named(vtk.vtkFloatArray, "of cells", 2, [(k, k) for k in range(COUNT)]))
    data.GetFieldData().AddArray(named(vtk.vtkDoubleArray, "TimeValue", 1, [(1.5,)]))
    return data


def as_grid(data):
    append = vtk.vtkAppendFilter()
    append.AddInputData(data)
    append.Update()
    grid = append.GetOutput()
    grid.GetFieldData().AddArray(data.GetFieldData().GetArray(0))
    return grid


def write_xml(name, data, mode, big_endian=False, wide=False, compressed=False, base64=True, grid=False):
    writer = vtk.vtkXMLUnstructuredGridWriter() if grid else vtk.vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(name)
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary,
     "appended": writer.SetDataModeToAppended}[mode]()
    writer.SetEncodeAppendedData(base64)
    writer.SetByteOrder(0 if big_endian else 1)
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetCompressorTypeToZLib() if compressed else writer.SetCompressorTypeToNone()
    writer.SetBlockSize(64)  # several compressed blocks an array
    writer.Write()


def write_legacy(name, data, binary, grid=False, version=None):
    writer = vtk.vtkUnstructuredGridWriter() if grid else vtk.vtkPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(name)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    if version:
        writer.SetFileVersion(version)
    writer.Write()


def write_table(name, data):
    to_table = vtk.vtkDataObjectToTable()
    to_table.SetInputData(data)
    to_table.SetFieldType(1)
    to_table.Update()
    table = to_table.GetOutput()
    places = named(vtk.vtkDoubleArray, "Points", 3, [data.GetPoint(k) for k in range(COUNT)])
    table.GetRowData().AddArray(places)
    writer = vtk.vtkDelimitedTextWriter()
    writer.SetInputData(table)
    writer.SetFileName(name)
    writer.Write()


floats, doubles = particles(vtk.VTK_FLOAT), particles(vtk.VTK_DOUBLE)
write_xml("ascii.vtp", floats, "ascii")
write_xml("inline.vtp", doubles, "binary")
write_xml("inline_zlib_wide.vtp", floats, "binary", wide=True, compressed=True)
write_xml("appended_base64.vtp", floats, "appended", wide=True)
write_xml("appended_base64_zlib.vtp", doubles, "appended", compressed=True)
write_xml("appended_raw.vtp", doubles, "appended", base64=False)
write_xml("appended_raw_zlib_big.vtp", floats, "appended", big_endian=True, compressed=True, base64=False)
write_xml("inline_big.vtu", as_grid(floats), "binary", big_endian=True, grid=True)
write_legacy("ascii.vtk", floats, False)
write_legacy("binary.vtk", doubles, True)
write_legacy("binary_grid_42.vtk", as_grid(floats), True, grid=True, version=42)
write_table("table.csv", floats)
