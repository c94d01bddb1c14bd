"""What of the batch needs Blender, as a program or as `bpy`: its own files, FBX, Smart UV Project and renders.

Nothing but the worker's task imports these modules, and only for assets or settings that need them.
"""
