def check_mesh(m):
    return m
def run(m):
    return 0
