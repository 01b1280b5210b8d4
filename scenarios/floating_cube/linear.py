import sys
import numpy as np
from scipy.sparse import csr_matrix, coo_matrix
from scipy.sparse.linalg import splu
G=9.81
def added(side, draught, length, depth, h, s):
    """A/(rho a^2 d): s = w^2/g; s=inf: phi=0"""
    nx=round(length/2/h); nz=round(depth/h); nb=round(side/2/h); nd=round(draught/h)
    wet=np.ones((nx,nx,nz),bool); wet[:nb,:nb,nz-nd:]=False
    num=-np.ones(wet.shape,int); num[wet]=np.arange(wet.sum())
    n=wet.sum(); rows=[];cols=[];vals=[]; diag=np.zeros(n)
    for ax in range(3):
        lo=[slice(None)]*3; hi=[slice(None)]*3; lo[ax]=slice(None,-1); hi[ax]=slice(1,None)
        a=num[tuple(lo)].ravel(); b=num[tuple(hi)].ravel(); ok=(a>=0)&(b>=0); a=a[ok]; b=b[ok]
        rows+=[a,b]; cols+=[b,a]; vals+=[-np.ones(len(a))]*2
        np.add.at(diag,a,1.); np.add.at(diag,b,1.)
    top=num[:,:,-1]; top=top[top>=0]
    if np.isinf(s): diag[top]+=2.0
    else: diag[top]-= s*h/(1-s*h/2)
    # bottom of body: dphi/dn out of fluid: upward flux W=1 out -> laplacian source
    under=num[:nb,:nb,nz-nd-1].ravel()
    b=np.zeros(n); b[under]=h   # flux h^2*1 /h
    m=coo_matrix((np.r_[np.concatenate(vals),diag],(np.r_[np.concatenate(rows),np.arange(n)],np.r_[np.concatenate(cols),np.arange(n)]))).tocsc()
    phi=splu(m).solve(b)
    return (phi[under]+h/2).sum()*h*h*4/(side**2*draught), n
if __name__=="__main__":
    for h in (.015,):
        print("inf freq, big tank", h, added(.15,.12,.9,.6,h,np.inf))
    for L,D in ((.45,.3),):
      for h in (.015,.0075):
        D2=round(D/h)*h
        w2=G/.12/1.5
        for _ in range(8):
            ca,_n=added(.15,.12,L,D2,h,w2/G); w2=G/.12/(1+ca)
        print(L,D2,h,ca,2*np.pi/np.sqrt(w2))
