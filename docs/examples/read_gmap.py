# Prints the Gaussians of one scale of a .gmap file as CSV. Usage: python3 read_gmap.py MAP [SCALE]
import sqlite3, sys
import numpy as np, zstandard


def read_gmap(path, scale):
    """Per tile, one row per Gaussian: cells, means [m], covariances (upper triangles) [m^2], weights, log-odds."""
    database = sqlite3.connect(f"file:{path}?immutable=1", uri=True)
    identity = [database.execute("PRAGMA " + name).fetchone()[0] for name in ("application_id", "user_version")]
    if identity != [0x676D6170, 1]:
        raise ValueError(f"{path} is not a .gmap file of version 1")
    for (data,) in database.execute("SELECT data FROM tiles WHERE scale = ? ORDER BY x, y, z", (scale,)):
        yield read_tile(zstandard.ZstdDecompressor().decompress(data))


def read_tile(raw):
    dim, position = raw[0], 8 * (9 + raw[0])
    header = np.frombuffer(raw[:position], "<u8")
    (resolution, noise), tile = header[1:3].view("<f8"), header[9:].astype("<u4").view("<i4")
    ratio, scales, scale, cells, n, flags = map(int, header[3:9])  # n = number of Gaussians
    moments, labels, occupancy, final = (flags & bit for bit in (1, 2, 4, 8))
    span, side = next(ratio**k for k in range(1, 6) if ratio**k >= 32), resolution * ratio**scale

    def column(count, width):  # all lowest bytes, then all second bytes, ...
        nonlocal position
        begin, position = position, position + count * width
        numbers = np.zeros((count, 8), np.uint8)
        numbers[:, :width] = np.frombuffer(raw[begin:position], np.uint8).reshape(width, count).T
        return numbers.view("<i8")[:, 0]

    def read(count, width):  # in a final map: width, smallest number, differences from it
        width, smallest = (int(column(1, 1)[0]), column(1, 8)) if final else (width, 0)
        return smallest + column(count, width)

    keys = np.stack([read(cells, 4) + np.int64(span) * t for t in tile], axis=1)
    keys = np.repeat(keys, read(cells, 4), axis=0)  # from now on one row per Gaussian
    weights, *rest = (read(n, 8) for _ in range(1 + dim + dim * (dim + 1) // 2))
    means, cov, (rows, columns) = np.stack(rest[:dim], 1), np.stack(rest[dim:], 1), np.triu_indices(dim)
    if final:  # the covariance is L L', L a lower triangle, column by column
        lower = np.exp2(cov[:, :dim, None] / 16) * noise * np.eye(dim)
        below, left = np.triu_indices(dim, 1)[::-1]
        lower[:, below, left] = cov[:, dim:] / 32 * lower[:, below, below]
        cov, weights = lower @ lower.transpose(0, 2, 1), np.ldexp((weights % 16 + 16) / 32, weights // 16)
        steps = 1 / np.sqrt(np.diagonal(np.linalg.inv(cov), axis1=1, axis2=2)) / 8
        means, cov = np.clip(means * steps, -0.501 * side, 0.501 * side), cov[:, rows, columns]
    elif moments:  # number of points, sums of their offsets and of the products, in steps of the lattice
        points, step = weights[:, None], resolution / 65536
        cov = (cov / points - means[:, rows] / points * (means[:, columns] / points)) * step * step
        cov, means, weights = cov + noise * noise * (rows == columns), means * (step / points), weights.astype(float)
    else:
        weights, means, cov = weights.view("<f8"), means.view("<f8"), cov.view("<f8")
    parents = read(n, 4) if labels else None  # number of the parent in its cell
    odds = np.full(n, 10.0) if not occupancy else read(n, 4) / 16 if final else column(n, 4).astype("<u4").view("<f4")
    return keys, means + 0.5 * ((2 * keys + 1) * ratio**scale) * resolution, cov, weights, odds


if __name__ == "__main__":
    for tile in read_gmap(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 0):
        for cell, mean, covariance, weight, odds in zip(*tile):
            print(*cell, *mean, *covariance, weight, odds, sep=",")
